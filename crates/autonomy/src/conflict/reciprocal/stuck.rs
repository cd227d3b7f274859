//! What stuck robots do: they ask the robots in their way to make room.

use super::super::{Step, wait_cycles};
use super::Reciprocal;
use crate::event::Event;

/// A robot asks a moving robot to make room only if the cosine between their directions is smaller than this.
/// Robots in similar directions get on by themselves.
const ALONG: f32 = 0.3;

/// A parked robot in the way is asked to make room as soon as it slows another down to less than this share
/// of its preferred speed.
const SLOWED: f32 = 0.9;

impl Reciprocal {
    /// Lets a robot ask a parked robot that slows it down to make room. Returns whether the parked robot
    /// does.
    fn ask_parked(&mut self, step: &mut Step, i: usize) -> bool {
        let blocker = parked_robot_that_slows(step, i);
        let steps = &mut self.blocked_steps[i];
        *steps = if blocker.is_some() { *steps + 1 } else { 0 };
        let is_due = *steps == 1 || steps.is_multiple_of(step.model.reciprocal.ask_again);
        let asked = blocker.filter(|blocker| is_due && !self.retreats.serves(i, *blocker));
        asked.is_some_and(|blocker| self.make_room(step, i, blocker))
    }

    /// Lets a robot ask the robot in its way to make room: a parked one as soon as it slows the robot down,
    /// any other once the robot comes no nearer to its goal.
    pub(super) fn push(&mut self, step: &mut Step, i: usize, leaders: &[usize]) {
        if self.ask_parked(step, i) {
            return;
        }
        let me = &step.movers[i];
        let is_due = me.stalled_steps > 0
            && (me.stalled_steps.is_multiple_of(step.model.reciprocal.ask_again)
                || me.stalled_steps == step.model.reciprocal.stuck);
        if !is_due || !me.wishes_to_move() || step.scratch.turns[i].waits_for.is_some() {
            return;
        }
        let Some(blocker) = robot_in_the_way(step, i) else { return };
        if self.retreats.serves(i, blocker) {
            return;
        }
        if me.stalled_steps == step.model.reciprocal.stuck {
            step.log.push(Event::Deadlocked { robots: vec![me.robot, step.movers[blocker].robot] });
        }
        if !step.movers[blocker].wishes_to_move() || leaders.contains(&i) || may_push(step, i, blocker) {
            self.make_room(step, i, blocker);
        }
    }
}

/// The robot with the best claim on each ring of stuck robots. On a ring, every robot is in the way of
/// another, and none can get on by itself. So the leader may push the next robot whatever their
/// directions.
pub(super) fn leaders_of_jams(step: &Step) -> Vec<usize> {
    let movers = &*step.movers;
    let is_stuck =
        |i: &usize| movers[*i].stalled_steps >= step.model.reciprocal.stuck && movers[*i].wishes_to_move();
    if !(0..movers.len()).any(|i| is_stuck(&i)) {
        return Vec::new();
    }
    let in_the_way = |i: usize| Some(i).filter(is_stuck).and_then(|i| robot_in_the_way(step, i));
    let waits_for: Vec<Option<usize>> = (0..movers.len()).map(in_the_way).collect();
    let claim = |a: &usize, b: &usize| {
        let longest_first = movers[*b].stalled_steps.cmp(&movers[*a].stalled_steps);
        longest_first.then(movers[*a].priority.precedence(&movers[*b].priority))
    };
    let rings = wait_cycles(&waits_for);
    rings.iter().filter_map(|ring| ring.iter().copied().min_by(claim)).collect()
}

fn parked_robot_that_slows(step: &Step, i: usize) -> Option<usize> {
    let movers = &*step.movers;
    let me = &movers[i];
    let is_parked = |j: &usize| !movers[*j].wishes_to_move();
    let is_slowed = step.directives[i].velocity().dot(me.preferred) < SLOWED * me.preferred.length_squared();
    let may_ask = is_slowed && step.scratch.turns[i].waits_for.is_none();
    if !may_ask || !step.scratch.near[i].robots.iter().any(is_parked) {
        return None;
    }
    robot_in_the_way(step, i).filter(is_parked)
}

/// Whether a robot may ask another robot with a goal of its own to make room.
fn may_push(step: &Step, i: usize, blocker: usize) -> bool {
    let (me, other) = (&step.movers[i], &step.movers[blocker]);
    let goes_after = match (step.scratch.turns[i].rank, step.scratch.turns[blocker].rank) {
        (Some(mine), Some(its)) => its < mine,
        _ => false,
    };
    let has_better_claim = || {
        let longest_first = other.stalled_steps.cmp(&me.stalled_steps);
        longest_first.then(me.priority.precedence(&other.priority)).is_lt()
    };
    me.stalled_steps >= step.model.reciprocal.stuck
        && !goes_after
        && me.preferred.normalize_or_zero().dot(other.preferred.normalize_or_zero()) < ALONG
        && has_better_claim()
}

/// The nearest robot in the way of a robot's preferred velocity.
fn robot_in_the_way(step: &Step, i: usize) -> Option<usize> {
    step.scratch.near[i].robot_in_the_way(i, step.movers, &step.model.reciprocal)
}

#[cfg(test)]
mod tests {
    use crate::conflict::Directive;
    use crate::conflict::testing::{Bench, mover};
    use crate::ids::RobotId;

    /// Robots that make room when a robot drives east towards robots that stand on a line across its way.
    fn asked(gap: f32, standing: &[f32]) -> Vec<RobotId> {
        let mut movers = vec![mover(0, [5.0, 8.0], [2.0, 0.0])];
        movers[0].velocity = movers[0].preferred;
        let at = |y: &f32| [5.8 + gap, *y];
        movers.extend((1..).zip(standing).map(|(id, y)| mover(id, at(y), [0.0, 0.0])));
        let mut bench = Bench::new();
        bench.resolve(&mut movers);
        let directives = bench.resolve(&mut movers);
        let makes_room = |directive: &Directive| matches!(directive, Directive::Retreat { .. });
        (0..)
            .zip(&directives)
            .filter(|(_, directive)| makes_room(directive))
            .map(|(i, _)| RobotId(i))
            .collect()
    }

    #[test]
    fn a_parked_robot_is_asked_as_soon_as_it_slows_another_down() {
        let row = [6.1, 7.05, 8.0, 8.95, 9.9];
        assert_eq!(asked(1.0, &row), [RobotId(3)], "the row leaves no gap");
        assert_eq!(asked(6.0, &row), [], "far away");
        assert_eq!(asked(1.0, &[6.5, 9.5]), [], "between two robots there is room");
    }
}
