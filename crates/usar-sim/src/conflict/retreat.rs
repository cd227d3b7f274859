//! Robots that make room: who does, for whom, and until when.
//!
//! A robot in the way of one with the right of way inherits its priority (as in PIBT; Okumura, Machida, Défago & Tamura, 2022) and
//! retreats to the nearest place that leaves room. Whoever stands in *its* way makes room in turn: a chain, whose depth is counted.

use std::collections::{BTreeMap, BTreeSet};

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use super::Mover;
use super::predict::Neighbours;
use super::room::{Ask, distance_to_way, ways};
use crate::world::STANDING_MPS;

/// Longest chain of robots that make room for one another.
const MAX_DEPTH: u32 = 12;

/// Share of its top speed at which a robot retreats.
const RETREAT_SPEED: f32 = 0.8;

/// A waypoint of a retreat counts as passed within this distance, in metres.
const PASSED_M: f32 = 0.1;

/// Coming nearer by less than this is no progress, in metres.
const PROGRESS_M: f32 = 0.05;

/// Robots farther than this from one that makes room do not matter to it, in metres.
const CROWD_RANGE_M: f32 = 25.0;

/// Distance between the points at which a retreat is compared with the way of the other robot, in metres.
const SAMPLE_M: f32 = 0.4;

/// Robots within this distance of one that makes room go through in one platoon, in metres.
const PLATOON_M: f32 = 5.0;

/// Robots whose wishes differ by no more than this (cosine) go in the same direction.
const PLATOON_COS: f32 = 0.5;

/// How long robots try, in steps.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Limits {
    /// On the way to the place, without coming nearer to it.
    pub(super) underway: u32,
    /// At the place, while the other robot stands.
    pub(super) at_place: u32,
    /// After it came to nothing, before they are asked again.
    pub(super) respite: u32,
}

/// One robot that makes room.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Retreat {
    /// The robot for which it makes room.
    pub(super) head: usize,
    /// 1 when `head` is on its own way, one more than the retreat of `head` otherwise.
    pub(super) depth: u32,
    /// Waypoints to the place, the next one last; empty at the place.
    path: Vec<Vector>,
    /// The whole way from where it was in the way to the place, at short distances.
    line: Vec<Vector>,
    least_left: f32,
    idle_steps: u32,
    /// Steps since it began to make room, for whomever.
    held_steps: u32,
}

/// All retreats, by robot.
#[derive(Default, Serialize, Deserialize)]
pub(super) struct Retreats {
    of: BTreeMap<usize, Retreat>,
    /// For whom, and who makes room: the retreats by their heads. Follows from `of`.
    #[serde(skip)]
    served: BTreeSet<(usize, usize)>,
    /// Steps for which a robot is not asked again.
    respite: Vec<u32>,
    #[serde(skip)]
    limits: Limits,
    #[serde(skip)]
    margin: f32,
    #[serde(skip)]
    arena: Vector,
}

impl Retreats {
    /// The robots that make room, in order.
    pub(super) fn iter(&self) -> impl Iterator<Item = (usize, &Retreat)> {
        self.of.iter().map(|(i, retreat)| (*i, retreat))
    }

    /// The robot for which this one makes room.
    pub(super) fn head_of(&self, i: usize) -> Option<usize> {
        self.of.get(&i).map(|retreat| retreat.head)
    }

    /// Place in the chain of a robot: 0 for one on its own way.
    pub(super) fn depth(&self, i: usize) -> u32 {
        self.of.get(&i).map_or(0, |retreat| retreat.depth)
    }

    /// Whether somebody is on the way to make room for this robot. Depths grow along a chain, so that patience ends somewhere.
    pub(super) fn is_served(&self, i: usize) -> bool {
        let depth = self.depth(i);
        let serves = |retreat: &Retreat| retreat.depth > depth && !retreat.path.is_empty();
        self.served.range((i, 0)..=(i, usize::MAX)).any(|(_, maker)| serves(&self.of[maker]))
    }

    fn is_at_place(&self, i: usize) -> bool {
        self.of.get(&i).is_some_and(|retreat| retreat.path.is_empty())
    }

    /// Makes what a snapshot leaves out because it is fixed or follows from the rest.
    pub(super) fn restore(&mut self, limits: Limits, margin: f32, arena: Vector) {
        (self.limits, self.margin, self.arena) = (limits, margin, arena);
        self.served = self.of.iter().map(|(i, retreat)| (retreat.head, *i)).collect();
    }

    fn begin(&mut self, i: usize, retreat: Retreat) {
        self.end(i);
        self.served.insert((retreat.head, i));
        self.of.insert(i, retreat);
    }

    fn end(&mut self, i: usize) -> Option<Retreat> {
        let retreat = self.of.remove(&i)?;
        self.served.remove(&(retreat.head, i));
        Some(retreat)
    }

    /// Ends the retreats that are over, and gives the others the wish to go to their place.
    pub(super) fn follow(&mut self, movers: &mut [Mover], neighbours: &Neighbours) {
        self.respite.resize(movers.len(), 0);
        self.respite.iter_mut().for_each(|steps| *steps = steps.saturating_sub(1));
        let makers: Vec<usize> = self.of.keys().copied().collect();
        for i in makers {
            let is_served = self.is_served(i);
            let Some(mut retreat) = self.end(i) else { continue };
            retreat.advance(&movers[i], &movers[retreat.head], is_served);
            if !self.is_over(i, &retreat, movers) {
                self.begin(i, retreat);
            } else if let Some(retreat) = self.for_the_next(i, retreat, movers, neighbours) {
                self.begin(i, retreat);
            }
        }
        for (i, retreat) in &self.of {
            retreat.guide(&mut movers[*i]);
        }
    }

    fn is_over(&self, i: usize, retreat: &Retreat, movers: &[Mover]) -> bool {
        let (me, head) = (&movers[i], &movers[retreat.head]);
        let head_way: Vec<Vector> = match self.of.get(&retreat.head) {
            Some(other) => other.way(head),
            None if head.wishes_to_move() => {
                std::iter::once(head.position).chain(head.route.iter().copied()).collect()
            }
            None => return true,
        };
        !me.can_make_room
            || self.is_out_of_patience(retreat)
            || retreat.is_passed(&head_way, me.radius + head.radius + self.margin)
    }

    fn is_out_of_patience(&self, retreat: &Retreat) -> bool {
        let limit = if retreat.path.is_empty() { self.limits.at_place } else { self.limits.underway };
        retreat.idle_steps > limit
    }

    /// The same room for the next robot that comes after the one that passed: robots go through a narrow passage in platoons, not one at a
    /// time from either side.
    fn for_the_next(
        &self,
        i: usize,
        mut retreat: Retreat,
        movers: &[Mover],
        neighbours: &Neighbours,
    ) -> Option<Retreat> {
        let (me, passed) = (&movers[i], &movers[retreat.head]);
        let direction = passed.wish.normalize_or_zero();
        let follows = |k: &usize| {
            let other = &movers[*k];
            *k != i
                && *k != retreat.head
                && other.aerial == me.aerial
                && self.depth(*k) == 0
                && other.wish.normalize_or_zero().dot(direction) > PLATOON_COS
                && !retreat.is_passed(&ways(other)[0], me.radius + other.radius + self.margin)
        };
        if !me.can_make_room || self.is_out_of_patience(&retreat) || retreat.held_steps > self.limits.at_place
        {
            return None;
        }
        let near = |k: &usize| (movers[*k].position - me.position).length();
        let next = neighbours
            .within(movers, me.position, PLATOON_M)
            .filter(follows)
            .min_by(|a, b| near(a).total_cmp(&near(b)).then(a.cmp(b)))?;
        retreat.head = next;
        retreat.depth = 1;
        retreat.idle_steps = 0;
        Some(retreat)
    }

    /// Ends the retreat of a robot, if it is on one that comes to nothing.
    pub(super) fn give_up(&mut self, i: usize) {
        if self.end(i).is_some() {
            self.respite[i] = self.limits.respite;
        }
    }

    /// Whether a robot is asked at all: it can move, and does not already make room for somebody with a better claim.
    pub(super) fn may_ask(&self, i: usize, blocker: usize, movers: &[Mover]) -> bool {
        movers[blocker].can_make_room
            && self.respite[blocker] == 0
            && self.depth(i) < MAX_DEPTH
            && (self.depth(blocker) <= self.depth(i) || self.is_at_place(blocker))
    }

    /// Has `blocker` make room for `i`. Whether it is in the way and there is room to make.
    pub(super) fn ask(
        &mut self,
        i: usize,
        blocker: usize,
        movers: &[Mover],
        neighbours: &Neighbours,
    ) -> bool {
        let Some(path) = self.find_room(i, blocker, movers, neighbours) else { return false };
        let retreat = Retreat {
            head: i,
            depth: self.depth(i) + 1,
            line: sampled(movers[blocker].position, &path),
            path: path.into_iter().rev().collect(),
            least_left: f32::INFINITY,
            idle_steps: 0,
            held_steps: 0,
        };
        let is_in_the_way = !self.is_over(blocker, &retreat, movers);
        if is_in_the_way {
            self.begin(blocker, retreat);
        }
        is_in_the_way
    }

    fn find_room(
        &self,
        i: usize,
        blocker: usize,
        movers: &[Mover],
        neighbours: &Neighbours,
    ) -> Option<Vec<Vector>> {
        let (me, head) = (&movers[blocker], &movers[i]);
        let others = || {
            let near = neighbours.within(movers, me.position, CROWD_RANGE_M).map(|k| (k, &movers[k]));
            near.filter(|(k, other)| *k != i && *k != blocker && other.aerial == me.aerial)
        };
        let disc = |at: Vector, other: &Mover| (at, me.radius + other.radius);
        let reserved = others().filter_map(|(k, other)| {
            let place = self.of.get(&k)?.path.first()?;
            Some(disc(*place, other))
        });
        let [route, behind] = ways(head);
        let mut ask = Ask {
            me,
            head,
            way: self.of.get(&i).map_or(route, |retreat| retreat.way(head)),
            through_head: false,
            crowd: others().map(|(_, other)| disc(other.position, other)).collect(),
            reserved: reserved.collect(),
            margin: self.margin,
            arena: self.arena,
        };
        ask.find().or_else(|| {
            ask.way.extend(behind); // both would have to get out of here: off the whole way of `head`
            ask.through_head = true;
            ask.find()
        })
    }
}

/// Points of a way, at most `SAMPLE_M` apart.
fn sampled(from: Vector, path: &[Vector]) -> Vec<Vector> {
    let mut points = vec![from];
    for to in path {
        let start = points[points.len() - 1];
        let count = ((*to - start).length() / SAMPLE_M).ceil().max(1.0);
        points.extend((1..=count as u32).map(|k| start.lerp(*to, k as f32 / count)));
    }
    points
}

impl Retreat {
    /// The way to the place, from where the robot is.
    fn way(&self, me: &Mover) -> Vec<Vector> {
        std::iter::once(me.position).chain(self.path.iter().rev().copied()).collect()
    }

    /// Whether the way of the other robot keeps this far, in metres, from the whole way of the retreat.
    fn is_passed(&self, head_way: &[Vector], apart: f32) -> bool {
        self.line.iter().all(|point| distance_to_way(*point, head_way) > 0.95 * apart)
    }

    fn advance(&mut self, me: &Mover, head: &Mover, is_served: bool) {
        self.held_steps += 1;
        while self.path.last().is_some_and(|next| (*next - me.position).length() < PASSED_M) {
            self.path.pop();
            self.least_left = f32::INFINITY;
        }
        let left = self.path.last().map_or(0.0, |next| (*next - me.position).length());
        let waits_for_mover = self.path.is_empty() && head.velocity.length() > STANDING_MPS;
        if left < self.least_left - PROGRESS_M || waits_for_mover || is_served {
            self.least_left = left;
            self.idle_steps = 0;
        } else {
            self.idle_steps += 1;
        }
    }

    /// Lets a robot wish to go where it makes room, or to stay there.
    fn guide(&self, me: &mut Mover) {
        let Some(next) = self.path.last() else {
            me.wish = Vector::ZERO;
            return;
        };
        let to_next = *next - me.position;
        me.retreat_left = Some(self.way(me).windows(2).map(|leg| (leg[1] - leg[0]).length()).sum());
        me.leg_left = to_next.length();
        let reachable = (2.0 * me.braking * me.leg_left).sqrt().max(0.05);
        me.wish = to_next.normalize_or_zero() * (RETREAT_SPEED * me.speed).min(reachable);
    }
}
