//! The directive of each robot in one step, from what all robots wish. Each robot is steered by itself, so
//! the robots of a large team can be steered at the same time.

use parry2d::math::Vector;

use super::encounter::Encounter;
use super::half_planes::HalfPlane;
use super::passage::Turn;
use super::unhindered::Unhindered;
use super::velocity::{Avoidance, HEEDED, MARGIN_M, Neighbour, SHARE_OF_PRIORITY, SHARE_OF_THE_FIRST};
use super::walls::NearWalls;
use crate::conflict::passing::nearest_in_the_way;
use crate::conflict::predict::Neighbours;
use crate::conflict::{Directive, Mover};
use crate::model::ReciprocalModel;

/// Slower than this is no motion, in metres per second.
const STILL_MPS: f32 = 0.005;

/// A robot in a queue waits for the robot ahead if it is slower than this, in metres per second.
const QUEUES_MPS: f32 = 0.05;

/// A robot adapts its velocity in every step if it would cover the gap to another within this time at its top
/// speed, in seconds.
const CLOSE_S: f32 = 0.5;

/// What one robot sees when it looks for its velocity. It is kept only to reuse its memory.
#[derive(Default)]
pub(in crate::conflict) struct Sight {
    /// Gap and index of each robot that it heeds.
    heeded: Vec<(f32, usize)>,
    pub(super) planes: Vec<HalfPlane>,
}

impl Sight {
    /// Notes which of its neighbours a robot heeds: all of them, or the nearest, the nearest first.
    fn heed(&mut self, me: &Mover, movers: &[Mover], near: &[usize]) {
        let gap = |j: &usize| {
            let other = &movers[*j];
            ((other.position - me.position).length() - (me.radius + other.radius + MARGIN_M), *j)
        };
        self.heeded.clear();
        self.heeded.extend(near.iter().map(gap));
        if near.len() <= HEEDED {
            self.heeded.sort_unstable_by_key(|(_, j)| *j);
        } else {
            let nearer = |a: &(f32, usize), b: &(f32, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
            self.heeded.select_nth_unstable_by(HEEDED, nearer);
            self.heeded.truncate(HEEDED);
            self.heeded.sort_unstable_by(nearer);
        }
    }
}

/// What is near one robot.
#[derive(Default)]
pub(in crate::conflict) struct Near {
    walls: NearWalls,
    /// The robots, in no particular order; none if nobody hinders it and it is not stuck.
    pub(super) robots: Vec<usize>,
}

/// All robots of a step, for the directive of each.
pub(super) struct Steering<'s, 'm> {
    pub(super) rules: &'s ReciprocalModel,
    pub(super) movers: &'s [Mover<'m>],
    pub(super) neighbours: &'s Neighbours,
    pub(super) unhindered: &'s Unhindered,
    pub(super) turns: &'s [Turn],
    /// For each robot, the direction of its preferred velocity; zero if it has nowhere to go.
    pub(super) directions: &'s [Vector],
    /// For each robot, the robot for which it makes room.
    pub(super) heads: &'s [Option<usize>],
    /// Robots farther apart than this do not matter, in metres.
    pub(super) range: f32,
}

impl Steering<'_, '_> {
    /// The directives of these robots, from the `first` on.
    pub(super) fn steer<'a>(
        &self,
        first: usize,
        robots: impl Iterator<Item = ((&'a mut Directive, &'a mut Avoidance), &'a mut Near)>,
        sight: &mut Sight,
    ) {
        for (i, ((directive, avoidance), near)) in robots.enumerate() {
            *directive = self.directive(first + i, avoidance, near, sight);
        }
    }

    /// The directive of a robot: the velocity that it takes among the others, or why it stands still.
    fn directive(
        &self,
        i: usize,
        avoidance: &mut Avoidance,
        near: &mut Near,
        sight: &mut Sight,
    ) -> Directive {
        let (movers, turn) = (self.movers, &self.turns[i]);
        let me = &movers[i];
        near.robots.clear();
        avoidance.neighbours.clear();
        if !me.can_make_room && !me.wishes_to_move() {
            return Directive::Stand;
        }
        let velocity = self.velocity(i, avoidance, near, sight);
        let is_still = velocity.length() < STILL_MPS;
        if let Some(head) = self.heads[i] {
            return Directive::Retreat { velocity, room_for: movers[head].robot };
        }
        match turn.waits_for {
            Some(first) if is_still => Directive::Yield { to: movers[first].robot },
            _ if me.wishes_to_move() && is_still => {
                Directive::Blocked { by: self.robot_in_the_way(i, near).map(|j| movers[j].robot) }
            }
            _ if me.wishes_to_move() => match self.robot_ahead(i, velocity, near) {
                Some(ahead) => Directive::Follow { velocity, behind: movers[ahead].robot },
                None => Directive::Proceed(velocity),
            },
            _ if is_still => Directive::Stand,
            _ => Directive::GiveWay(velocity),
        }
    }

    /// The velocity that a robot takes. Looks for the robots near it if it needs them, now or because it is
    /// stuck.
    fn velocity(&self, i: usize, avoidance: &mut Avoidance, near: &mut Near, sight: &mut Sight) -> Vector {
        let (me, arena) = (&self.movers[i], self.rules.retreats.arena);
        let is_free = self.unhindered.is_free(i) && near.walls.are_clear(me, arena);
        let may_be_stuck = me.stalled_steps >= self.rules.ask_again.min(self.rules.stuck);
        if !is_free || may_be_stuck {
            self.neighbours.find(i, me, self.range, &mut near.robots);
        }
        if is_free {
            return me.preferred.clamp_length_max(me.speed);
        }
        sight.heed(me, self.movers, &near.robots);
        avoidance.neighbours.extend(sight.heeded.iter().map(|(_, j)| self.neighbour(i, *j)));
        avoidance.walls.clear();
        near.walls.planes(me, arena, &mut avoidance.walls);
        (avoidance.preferred, avoidance.speed) = (me.preferred, me.speed);
        avoidance.straight_for_s = me.leg_left / me.speed.max(0.01);
        avoidance.is_open = self.turns[i].rank.is_none();
        let track_of = |j: usize| self.movers[j].track();
        let velocity = avoidance.velocity(me.track(), track_of, &mut sight.planes);
        if sight.heeded.iter().all(|(gap, _)| *gap > me.speed * CLOSE_S) {
            avoidance.neighbours.clear();
        }
        velocity
    }

    /// The robot behind which a robot with this velocity queues, or comes no nearer to its goal.
    fn robot_ahead(&self, i: usize, velocity: Vector, near: &Near) -> Option<usize> {
        let queues = velocity.length() < QUEUES_MPS;
        let first = self.turns[i].follows.filter(|_| queues).map(|first| first.robot);
        let is_stuck = self.movers[i].stalled_steps >= self.rules.stuck;
        first.or_else(|| is_stuck.then(|| self.robot_in_the_way(i, near)).flatten())
    }

    /// The nearest robot in the way of a robot's preferred velocity.
    pub(super) fn robot_in_the_way(&self, i: usize, near: &Near) -> Option<usize> {
        near.robot_in_the_way(i, self.movers, self.rules)
    }

    fn neighbour(&self, i: usize, j: usize) -> Neighbour {
        let (me, other, heads) = (&self.movers[i], &self.movers[j], self.heads);
        let encounter = self.encounter(i, j);
        let share = match (self.turns[i].rank, self.turns[j].rank) {
            _ if !other.can_make_room => 1.0,
            _ if heads[j] == Some(i) => SHARE_OF_PRIORITY,
            _ if heads[i] == Some(j) => 1.0 - SHARE_OF_PRIORITY,
            (Some(mine), Some(its)) if mine < its => SHARE_OF_THE_FIRST,
            (Some(_), Some(_)) => 1.0 - SHARE_OF_THE_FIRST,
            _ if matches!(encounter, Encounter::Crossing | Encounter::Parallel) => 0.5,
            _ if me.priority.precedence(&other.priority).is_lt() => SHARE_OF_PRIORITY,
            _ => 1.0 - SHARE_OF_PRIORITY,
        };
        Neighbour { robot: j, apart: me.radius + other.radius + MARGIN_M, share, encounter }
    }

    fn encounter(&self, i: usize, j: usize) -> Encounter {
        if self.heads[i] == Some(j) || self.heads[j] == Some(i) {
            return Encounter::MakesRoom;
        }
        Encounter::of(self.directions[i], self.directions[j])
    }
}

impl Near {
    /// The nearest robot in the way of the preferred velocity of robot `i`, whose surroundings these are.
    pub(super) fn robot_in_the_way(
        &self,
        i: usize,
        movers: &[Mover],
        rules: &ReciprocalModel,
    ) -> Option<usize> {
        let me = &movers[i];
        let near = self.robots.iter().map(|j| me.sees(*j, movers));
        nearest_in_the_way(me.preferred, rules.retreats.margin, near)
    }
}
