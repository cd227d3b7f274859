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
mod stuck;
mod velocity;

use parry2d::math::Vector;

use super::passing::nearest_in_the_way;
use super::{Directive, Mover, Resolver};
use crate::event::{Event, EventLog};
use encounter::{Encounter, LONGEST_HORIZON_S};
pub(super) use passage::Entry;
use passage::{Entrant, Follows, decide};
use velocity::{MARGIN_M, Neighbour, avoiding_velocity};

/// A robot that has come no nearer for this long, in seconds, is stuck.
pub(super) const STUCK_S: f64 = 4.0;

/// A robot that has waited this long before a passage, in seconds, ends the turn of the other direction.
pub(super) const TURN_S: f64 = 10.0;

/// Robots wait at this distance from a passage, beyond their radius, in metres.
const WAIT_AT_M: f32 = 0.6;

/// Robots within this distance of their waiting place make room for robots that leave the passage, in metres.
const MAKE_ROOM_M: f32 = 1.0;

/// Free way between robots that enter a passage one after another, in metres.
const FOLLOWING_GAP_M: f32 = 0.05;

/// A robot that enters a passage after another closes the gap between them in this time, in seconds.
const CLOSE_UP_S: f32 = 0.3;

/// A robot in a queue wishes to go at least this fast, in metres per second: it has not arrived.
const LEAST_WISH_MPS: f32 = 0.02;

/// A robot that has come no nearer for this long, in seconds, holds up no robot behind it. At the least wish
/// a robot may count as such for a moment; then the robot behind closes up.
pub(super) const HOLDS_QUEUE_S: f64 = 2.0;

/// A robot that makes room and gets no nearer to its place for this long, in seconds, is let out by the robot
/// for which it does so.
pub(super) const LET_OUT_S: f64 = 2.0;

/// A robot lets another out as long as there is less than this between them, in metres.
const LET_OUT_GAP_M: f32 = 0.15;

/// Share of its top speed at which a robot lets another out.
const LET_OUT_SPEED: f32 = 0.2;

/// Share of the avoidance that the robot with the right of way at a passage takes; the other robot takes the
/// rest.
const SHARE_OF_THE_FIRST: f32 = 0.3;

/// Share of the avoidance in the open that the robot with the better claim takes, and share of a robot in
/// the avoidance of one that makes room for it.
const SHARE_OF_PRIORITY: f32 = 0.2;

/// Slower than this is no motion, in metres per second.
const STILL_MPS: f32 = 0.005;

/// A robot in a queue waits for the robot ahead if it is slower than this, in metres per second.
const QUEUES_MPS: f32 = 0.05;

impl Resolver {
    /// One directive for each mover, by the default rule. Limits the wishes of robots that wait before a
    /// passage or queue there, and replaces those of robots that let others out.
    pub(super) fn reciprocate(&mut self, movers: &mut [Mover], log: &mut EventLog) {
        self.neighbours.pair(movers, MARGIN_M, LONGEST_HORIZON_S);
        self.hold_before_passages(movers, log);
        self.queue_before_passages(movers);
        self.let_out(movers);
        for i in 0..movers.len() {
            self.directives[i] = self.steer(i, movers);
        }
        let leaders = self.leaders_of_jams(movers);
        for i in 0..movers.len() {
            self.push(i, movers, &leaders, log);
        }
    }

    /// Lets robots wait before narrow passages in which others have the right of way, and make room there.
    fn hold_before_passages(&mut self, movers: &mut [Mover], log: &mut EventLog) {
        self.entries.resize(movers.len(), Entry::default());
        for entry in &mut self.entries {
            (entry.rank, entry.waits_for, entry.follows) = (None, None, None);
        }
        let entrants: Vec<Entrant> =
            movers.iter().enumerate().filter_map(|(i, me)| Entrant::new(i, me)).collect();
        decide(&entrants, movers, &mut self.entries, self.turn_steps);
        for entry in &mut self.entries {
            entry.is_granted = entry.rank.is_some() && entry.waits_for.is_none();
            entry.waited_steps = if entry.waits_for.is_some() { entry.waited_steps + 1 } else { 0 };
        }
        let waiting =
            |entrant: &Entrant| Some((entrant.i, self.entries[entrant.i].waits_for?, entrant.ahead));
        let waiting: Vec<(usize, usize, f32)> = entrants.iter().filter_map(waiting).collect();
        for (i, first, ahead) in &waiting {
            if self.entries[*i].waited_steps == 1 {
                log.push(Event::ConflictStarted { robots: vec![movers[*first].robot, movers[*i].robot] });
            }
            let is_near = *ahead < movers[*i].radius + WAIT_AT_M + MAKE_ROOM_M;
            if is_near && self.retreats.depth(*i) == 0 {
                self.make_room(*first, *i, movers, log);
            }
        }
        self.make_room_in_bays(&entrants, movers, log);
        for (i, _, ahead) in waiting {
            let me = &mut movers[i];
            let stops_in: f32 = (ahead - me.radius - WAIT_AT_M).max(0.0);
            me.wish = me.wish.clamp_length_max((2.0 * me.braking * stops_in).sqrt());
        }
    }

    /// Lets the first of two robots that come to a bay from both sides make room in it for the second.
    fn make_room_in_bays(&mut self, entrants: &[Entrant], movers: &[Mover], log: &mut EventLog) {
        for me in entrants {
            let Some(other) = entrants.iter().find(|other| me.makes_room_in_bay(other, movers)) else {
                continue;
            };
            if self.retreats.depth(me.i) == 0 && self.retreats.depth(other.i) == 0 {
                self.make_room(other.i, me.i, movers, log);
            }
        }
    }

    /// Lets robots that may enter a passage in the same direction do so one after another, at a small
    /// distance. All at once, they would press against one another at its mouth.
    fn queue_before_passages(&self, movers: &mut [Mover]) {
        for (i, entry) in self.entries.iter().enumerate() {
            let Some(Follows { robot, gap }) = entry.follows else { continue };
            let first = &movers[robot];
            if first.stalled_steps > self.holds_queue_steps {
                continue;
            }
            let allowed = first.velocity.length() + (gap - FOLLOWING_GAP_M) / CLOSE_UP_S;
            movers[i].wish = movers[i].wish.clamp_length_max(allowed.max(LEAST_WISH_MPS));
        }
    }

    /// Lets robots step back from robots beside them that try to make room for them and get nowhere, as in a
    /// corner.
    fn let_out(&self, movers: &mut [Mover]) {
        for (i, retreat) in self.retreats.iter() {
            let (me, head) = (&movers[i], &movers[retreat.head]);
            let away = head.position - me.position;
            let is_near = away.length() < me.radius + head.radius + LET_OUT_GAP_M;
            if is_near && head.can_make_room && retreat.is_held_up(self.let_out_steps) {
                movers[retreat.head].wish = away.normalize_or_zero() * LET_OUT_SPEED * head.speed;
            }
        }
    }

    /// The directive of a robot: the velocity that it takes among the others, or why it stands still.
    fn steer(&self, i: usize, movers: &[Mover]) -> Directive {
        let me = &movers[i];
        if !me.can_make_room && !me.wishes_to_move() {
            return Directive::Stand;
        }
        let neighbours = self.neighbours.of(i).iter().map(|j| self.neighbour(i, *j, movers)).collect();
        let velocity = avoiding_velocity(me, neighbours, self.arena, self.entries[i].rank.is_none());
        let is_still = velocity.length() < STILL_MPS;
        if let Some(head) = self.retreats.head_of(i) {
            return Directive::Retreat { velocity, room_for: movers[head].robot };
        }
        match self.entries[i].waits_for {
            Some(first) if is_still => Directive::Yield { to: movers[first].robot },
            _ if me.wishes_to_move() && is_still => {
                Directive::Blocked { by: self.robot_in_the_way(i, movers).map(|j| movers[j].robot) }
            }
            _ if me.wishes_to_move() => match self.robot_ahead(i, velocity, movers) {
                Some(ahead) => Directive::Follow { velocity, behind: movers[ahead].robot },
                None => Directive::Proceed(velocity),
            },
            _ if is_still => Directive::Stand,
            _ => Directive::GiveWay(velocity),
        }
    }

    /// The robot behind which a robot with this velocity queues, or comes no nearer to its goal.
    fn robot_ahead(&self, i: usize, velocity: Vector, movers: &[Mover]) -> Option<usize> {
        let queues = velocity.length() < QUEUES_MPS;
        let first = self.entries[i].follows.filter(|_| queues).map(|first| first.robot);
        let is_stuck = movers[i].stalled_steps >= self.stuck_steps;
        first.or_else(|| is_stuck.then(|| self.robot_in_the_way(i, movers)).flatten())
    }

    fn neighbour(&self, i: usize, j: usize, movers: &[Mover]) -> Neighbour {
        let (me, other) = (&movers[i], &movers[j]);
        let encounter = self.encounter(i, j, movers);
        let share = match (self.entries[i].rank, self.entries[j].rank) {
            _ if !other.can_make_room => 1.0,
            _ if self.retreats.head_of(j) == Some(i) => SHARE_OF_PRIORITY,
            _ if self.retreats.head_of(i) == Some(j) => 1.0 - SHARE_OF_PRIORITY,
            (Some(mine), Some(its)) if mine < its => SHARE_OF_THE_FIRST,
            (Some(_), Some(_)) => 1.0 - SHARE_OF_THE_FIRST,
            _ if matches!(encounter, Encounter::Crossing | Encounter::Parallel) => 0.5,
            _ if me.priority.precedence(&other.priority).is_lt() => SHARE_OF_PRIORITY,
            _ => 1.0 - SHARE_OF_PRIORITY,
        };
        Neighbour {
            offset: other.position - me.position,
            velocity: other.velocity,
            apart: me.radius + other.radius + MARGIN_M,
            share,
            encounter,
        }
    }

    fn encounter(&self, i: usize, j: usize, movers: &[Mover]) -> Encounter {
        if self.retreats.head_of(i) == Some(j) || self.retreats.head_of(j) == Some(i) {
            return Encounter::MakesRoom;
        }
        Encounter::of(movers[i].wish, movers[j].wish)
    }

    /// The nearest robot in the way of a robot's wish.
    fn robot_in_the_way(&self, i: usize, movers: &[Mover]) -> Option<usize> {
        let (me, near) = (&movers[i], self.neighbours.of(i));
        let discs = near.iter().map(|j| (movers[*j].position - me.position, me.radius + movers[*j].radius));
        nearest_in_the_way(me.wish, &self.surroundings(i, me, discs)).map(|at| near[at])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conflict::testing::{mover, resolver};
    use crate::ids::RobotId;
    use crate::planning::Passage;

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
            resolver().resolve(&mut movers, &mut EventLog::default()).to_vec()
        };
        let queue = directives(0);
        assert!(matches!(queue[0], Directive::Proceed(velocity) if velocity.length() > 1.0), "{queue:?}");
        assert!(matches!(queue[1], Directive::Follow { behind: RobotId(0), .. }), "{queue:?}");
        assert_eq!(queue[1].waits_for(), Some(RobotId(0)));
        assert!(queue[1].velocity().length() <= LEAST_WISH_MPS, "{queue:?}");
        let released = directives(resolver().holds_queue_steps + 1);
        assert!(
            matches!(released[1], Directive::Proceed(velocity) if velocity.length() > 0.5),
            "{released:?}"
        );
    }

    #[test]
    fn a_robot_that_comes_no_nearer_waits_for_the_robot_in_its_way() {
        let mut resolver = resolver();
        let mut movers = [mover(0, [5.0, 5.0], [1.0, 0.0]), mover(1, [5.9, 5.05], [0.0, 0.0])];
        movers[0].stalled_steps = resolver.stuck_steps;
        let directives = resolver.resolve(&mut movers, &mut EventLog::default());
        assert_eq!(directives[0].waits_for(), Some(RobotId(1)), "{directives:?}");
    }

    #[test]
    fn a_resting_robot_that_was_pushed_aside_goes_back() {
        let directive = |wish: [f32; 2]| {
            let mut movers = [mover(0, [5.0, 5.0], wish)];
            movers[0].can_make_room = false;
            resolver().resolve(&mut movers, &mut EventLog::default())[0]
        };
        assert_eq!(directive([1.0, 0.0]), Directive::Proceed(Vector::X));
        assert_eq!(directive([0.0, 0.0]), Directive::Stand);
    }

    #[test]
    fn a_robot_steps_back_from_one_that_cannot_make_room_for_it() {
        let wish = |gap: f32, steps: u32, can_move: bool| {
            let mut resolver = resolver();
            let mut movers =
                [mover(0, [5.0, 5.0], [1.0, 0.0]), mover(1, [5.0 + 0.8 + gap, 5.0], [-1.0, 0.0])];
            movers[0].can_make_room = can_move;
            resolver.retreats.begin_held_up(1, 0, Vector::new(5.0, 7.0), steps);
            resolver.let_out(&mut movers);
            movers[0].wish
        };
        let held = resolver().let_out_steps + 1;
        assert_eq!(wish(0.05, held, true), Vector::new(-LET_OUT_SPEED * 2.0, 0.0));
        assert_eq!(wish(0.05, held - 1, true), Vector::X, "not held up for long enough");
        assert_eq!(wish(0.3, held, true), Vector::X, "not beside it");
        assert_eq!(wish(0.05, held, false), Vector::X, "it cannot move");
    }
}
