//! The default rule: reciprocal avoidance in the open, right of way in narrow passages, and pushing when a
//! robot is stuck.
//!
//! - *Open*: each robot takes its share in avoiding the others, and so do idle robots ([`velocity`]).
//! - *Narrow*: where two robots do not fit side by side, the robots of one direction go. The others wait
//!   outside and make room. Robots of one direction enter one after another ([`passage`]).
//! - *Stuck*: a robot that has come no nearer to its goal for a while asks the robot in its way to make room.
//!   That robot inherits its priority (`super::retreat`). The longer a robot is stuck, the better its claim.
//!   A robot that has nowhere to go is asked at once.

mod encounter;
mod half_planes;
mod passage;
mod steering;
mod stuck;
mod unhindered;
mod velocity;
mod walls;

use serde::{Deserialize, Serialize};

use super::predict::{largest, range};
use super::retreat::Retreats;
use super::{Directive, Mover, Scratch, Step};
use crate::event::Event;
use crate::report::Track;
use encounter::LONGEST_HORIZON_S;
pub(super) use passage::Turn;
use passage::{Entrant, Entry, Follows, decide};
use steering::Steering;
pub(super) use steering::{Near, Sight};
use stuck::leaders_of_jams;
pub(super) use unhindered::Unhindered;
use velocity::{Avoidance, MARGIN_M};

/// Robots with a wider gap between them do not heed one another, in metres, unless the fastest need more to
/// stop. It seldom matters: robots heed the nearest few.
const HEEDED_WITHIN_M: f32 = 3.0;

/// Robots wait at this distance from a passage, beyond their radius, in metres.
const WAIT_AT_M: f32 = 0.6;

/// Robots within this distance of their waiting place make room for robots that leave the passage, in metres.
const MAKE_ROOM_M: f32 = 1.0;

/// Free way between robots that enter a passage one after another, in metres.
const FOLLOWING_GAP_M: f32 = 0.05;

/// A robot that enters a passage after another closes the gap between them in this time, in seconds.
const CLOSE_UP_S: f32 = 0.3;

/// A robot in a queue wishes to go at least this fast, in metres per second: it has not arrived.
const LEAST_PREFERRED_MPS: f32 = 0.02;

/// A robot lets another out as long as there is less than this between them, in metres.
const LET_OUT_GAP_M: f32 = 0.15;

/// Share of its top speed at which a robot lets another out.
const LET_OUT_SPEED: f32 = 0.2;

/// The state of the default rule from step to step.
#[derive(Default, Serialize, Deserialize)]
pub(super) struct Reciprocal {
    pub(super) retreats: Retreats,
    /// For each robot, the number of successive steps in which a parked robot slowed it down.
    blocked_steps: Vec<u32>,
    /// For each robot, its state at a narrow passage.
    entries: Vec<Entry>,
    /// For each robot that is close to others, how it avoids them until the next control step.
    avoidances: Vec<Avoidance>,
}

impl Reciprocal {
    /// Adapts the velocities of robots that are close to others to how robots move now.
    pub(super) fn adapt(&self, directives: &mut [Directive], tracks: &[Track], scratch: &mut Scratch) {
        let executor = scratch.executor.for_team(tracks.len());
        let part = executor.part(tracks.len());
        scratch.sights.resize_with(tracks.len().div_ceil(part), Sight::default);
        let robots = directives.chunks_mut(part).zip(self.avoidances.chunks(part)).zip(tracks.chunks(part));
        executor.run(robots.zip(&mut scratch.sights), |(((directives, avoidances), own), sight)| {
            for ((directive, avoidance), me) in directives.iter_mut().zip(avoidances).zip(own) {
                if !avoidance.neighbours.is_empty() {
                    directive.set_velocity(avoidance.velocity(*me, |j| tracks[j], &mut sight.planes));
                }
            }
        });
    }

    /// One directive for each mover. Limits the preferred velocities of robots that wait before a passage or
    /// queue there, and replaces those of robots that let others out.
    pub(super) fn resolve(&mut self, step: &mut Step) {
        let Step { model, scratch, movers, .. } = step;
        self.blocked_steps.resize(movers.len(), 0);
        self.avoidances.resize_with(movers.len(), Avoidance::default);
        scratch.neighbours.sort(movers);
        self.retreats.follow(&model.reciprocal.retreats, movers, &scratch.neighbours);
        self.hold_before_passages(step);
        queue_before_passages(step);
        self.let_out(step);
        self.steer(step);
        let leaders = leaders_of_jams(step);
        for i in 0..step.movers.len() {
            self.push(step, i, &leaders);
        }
    }

    fn make_room(&mut self, step: &mut Step, i: usize, blocker: usize) -> bool {
        step.make_room(&mut self.retreats, &step.model.reciprocal.retreats, i, blocker)
    }

    /// Lets robots wait before narrow passages in which others have the right of way, and make room there.
    fn hold_before_passages(&mut self, step: &mut Step) {
        let (turns, entries) = (&mut step.scratch.turns, &mut self.entries);
        entries.resize(step.movers.len(), Entry::default());
        turns.clear();
        turns.resize(step.movers.len(), Turn::default());
        let movers = step.movers.iter().enumerate();
        let entrants: Vec<Entrant> = movers.filter_map(|(i, me)| Entrant::new(i, me)).collect();
        decide(&entrants, step.movers, entries, turns, step.model.reciprocal.turn);
        for (entry, turn) in entries.iter_mut().zip(turns.iter()) {
            entry.is_granted = turn.rank.is_some() && turn.waits_for.is_none();
            entry.waited_steps = if turn.waits_for.is_some() { entry.waited_steps + 1 } else { 0 };
        }
        let waiting = |entrant: &Entrant| Some((entrant.i, turns[entrant.i].waits_for?, entrant.ahead));
        let waiting: Vec<(usize, usize, f32)> = entrants.iter().filter_map(waiting).collect();
        for (i, first, ahead) in &waiting {
            if self.entries[*i].waited_steps == 1 {
                let robots = vec![step.movers[*first].robot, step.movers[*i].robot];
                step.log.push(Event::ConflictStarted { robots });
            }
            let is_near = *ahead < step.movers[*i].radius + WAIT_AT_M + MAKE_ROOM_M;
            if is_near && self.retreats.depth(*i) == 0 {
                self.make_room(step, *first, *i);
            }
        }
        self.make_room_in_bays(step, &entrants);
        for (i, _, ahead) in waiting {
            let me = &mut step.movers[i];
            let stops_in: f32 = (ahead - me.radius - WAIT_AT_M).max(0.0);
            me.preferred = me.preferred.clamp_length_max(me.brakes.speed_before(0.0, stops_in));
        }
    }

    /// Lets the first of two robots that come to a bay from both sides make room in it for the second.
    fn make_room_in_bays(&mut self, step: &mut Step, entrants: &[Entrant]) {
        for me in entrants {
            let Some(other) = entrants.iter().find(|other| me.makes_room_in_bay(other, step.movers)) else {
                continue;
            };
            let depth = |i: usize| self.retreats.depth(i);
            if depth(me.i) == 0 && depth(other.i) == 0 {
                self.make_room(step, other.i, me.i);
            }
        }
    }

    /// Lets robots step back from robots beside them that try to make room for them and get nowhere, as in a
    /// corner.
    fn let_out(&self, step: &mut Step) {
        for (i, retreat) in self.retreats.iter() {
            let (me, head) = (&step.movers[i], &step.movers[retreat.head]);
            let away = head.position - me.position;
            let is_near = away.length() < me.radius + head.radius + LET_OUT_GAP_M;
            if is_near && head.can_make_room && retreat.is_held_up(step.model.reciprocal.let_out) {
                step.movers[retreat.head].preferred = away.normalize_or_zero() * LET_OUT_SPEED * head.speed;
            }
        }
    }

    /// Directs all robots.
    fn steer(&mut self, step: &mut Step) {
        let Step { model, scratch, movers, directives, .. } = step;
        let Scratch { neighbours, unhindered, turns, directions, heads, near, sights, executor, .. } =
            &mut **scratch;
        let stopping = |mover: &Mover| 2.0 * mover.brakes.way(mover.speed);
        let heeded_within = movers.iter().map(stopping).fold(HEEDED_WITHIN_M, f32::max);
        let range = range(movers, MARGIN_M, LONGEST_HORIZON_S).min(heeded_within + 2.0 * largest(movers));
        let executor = executor.for_team(movers.len());
        unhindered.find(movers, neighbours, range, executor);
        directions.clear();
        directions.extend(movers.iter().map(|mover| mover.preferred.normalize_or_zero()));
        heads.clear();
        heads.resize(movers.len(), None);
        self.retreats.iter().for_each(|(i, retreat)| heads[i] = Some(retreat.head));
        near.resize_with(movers.len(), Near::default);
        let rules = &model.reciprocal;
        let steering = Steering { rules, movers, neighbours, unhindered, turns, directions, heads, range };
        let part = executor.part(movers.len());
        sights.resize_with(movers.len().div_ceil(part), Sight::default);
        let robots = directives.chunks_mut(part).zip(self.avoidances.chunks_mut(part));
        let robots = robots.zip(near.chunks_mut(part)).zip(sights).enumerate();
        executor.run(robots, |(at, (((directives, avoidances), near), sight))| {
            steering.steer(at * part, directives.iter_mut().zip(avoidances).zip(near), sight);
        });
    }
}

/// Lets robots that may enter a passage in the same direction do so one after another, at a small
/// distance. All at once, they would press against one another at its mouth.
fn queue_before_passages(step: &mut Step) {
    for (i, turn) in step.scratch.turns.iter().enumerate() {
        let Some(Follows { robot, gap }) = turn.follows else { continue };
        let first = &step.movers[robot];
        if first.stalled_steps > step.model.reciprocal.holds_queue {
            continue;
        }
        let allowed = first.velocity.length() + (gap - FOLLOWING_GAP_M) / CLOSE_UP_S;
        let me = &mut step.movers[i];
        me.preferred = me.preferred.clamp_length_max(allowed.max(LEAST_PREFERRED_MPS));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conflict::Directive;
    use crate::conflict::testing::{Bench, mover};
    use crate::ids::RobotId;
    use crate::planning::Passage;
    use parry2d::math::Vector;

    /// A robot that is to go 10 m east, through a passage between x = 10 and x = 12.
    fn entering(id: u32, [x, y]: [f32; 2]) -> Mover<'static> {
        let points = (0..=10_u8).map(|i| Vector::new(10.0 + f32::from(i) / 5.0, 8.0)).collect();
        let way = 10.0 - x;
        let passage = Passage { points, enters_at: 10.0 - way, leaves_at: 8.0 - way };
        Mover { passages: Box::leak(Box::new([passage])), ..mover(id, [x, y], [2.0, 0.0]) }
    }

    #[test]
    fn a_robot_beside_another_before_a_mouth_waits_for_it_unless_it_stands() {
        let directives = |stalled_steps: u32| {
            let mut movers = [entering(0, [9.0, 8.0]), entering(1, [8.8, 9.0])];
            movers[0].stalled_steps = stalled_steps;
            Bench::new().resolve(&mut movers)
        };
        let queue = directives(0);
        assert!(matches!(queue[0], Directive::Proceed(velocity) if velocity.length() > 1.0), "{queue:?}");
        assert!(matches!(queue[1], Directive::Follow { behind: RobotId(0), .. }), "{queue:?}");
        assert_eq!(queue[1].waits_for(), Some(RobotId(0)));
        assert!(queue[1].velocity().length() <= LEAST_PREFERRED_MPS, "{queue:?}");
        let released = directives(Bench::new().model.reciprocal.holds_queue + 1);
        assert!(
            matches!(released[1], Directive::Proceed(velocity) if velocity.length() > 0.5),
            "{released:?}"
        );
    }

    #[test]
    fn a_robot_that_comes_no_nearer_waits_for_the_robot_in_its_way() {
        let mut bench = Bench::new();
        let mut movers = [mover(0, [5.0, 5.0], [1.0, 0.0]), mover(1, [5.9, 5.05], [0.0, 0.0])];
        movers[0].stalled_steps = bench.model.reciprocal.stuck;
        let directives = bench.resolve(&mut movers);
        assert_eq!(directives[0].waits_for(), Some(RobotId(1)), "{directives:?}");
    }

    #[test]
    fn a_resting_robot_that_was_pushed_aside_goes_back() {
        let directive = |preferred: [f32; 2]| {
            let mut movers = [mover(0, [5.0, 5.0], preferred)];
            movers[0].can_make_room = false;
            Bench::new().resolve(&mut movers)[0]
        };
        assert_eq!(directive([1.0, 0.0]), Directive::Proceed(Vector::X));
        assert_eq!(directive([0.0, 0.0]), Directive::Stand);
    }

    #[test]
    fn a_robot_steps_back_from_one_that_cannot_make_room_for_it() {
        let preferred = |gap: f32, steps: u32, can_move: bool| {
            let mut bench = Bench::new();
            let mut movers =
                [mover(0, [5.0, 5.0], [1.0, 0.0]), mover(1, [5.0 + 0.8 + gap, 5.0], [-1.0, 0.0])];
            movers[0].can_make_room = can_move;
            bench.state.retreats.begin_held_up(1, 0, Vector::new(5.0, 7.0), steps);
            bench.step(&mut movers, |state, step| state.let_out(step));
            movers[0].preferred
        };
        let held = Bench::new().model.reciprocal.let_out + 1;
        assert_eq!(preferred(0.05, held, true), Vector::new(-LET_OUT_SPEED * 2.0, 0.0));
        assert_eq!(preferred(0.05, held - 1, true), Vector::X, "not held up for long enough");
        assert_eq!(preferred(0.3, held, true), Vector::X, "not beside it");
        assert_eq!(preferred(0.05, held, false), Vector::X, "it cannot move");
    }
}
