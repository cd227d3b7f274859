//! Robots that make room: which robot does so, for which robot, and until when.
//!
//! A robot in the way of a robot with the right of way inherits its priority (as in PIBT; Okumura, Machida,
//! Défago & Tamura, 2022) and retreats to the nearest place that leaves room. A robot in the way of this
//! retreat makes room in turn. The robots form a chain, and each knows its depth in the chain.

use std::collections::BTreeMap;

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use super::Mover;
use super::predict::Neighbours;
use super::yield_place::{Ask, distance_to_way, ways};
use crate::event::{Event, EventLog};
use crate::model::RetreatModel;
use crate::robot::STANDING_MPS;

/// Longest chain of robots that make room for one another.
const MAX_DEPTH: u32 = 12;

/// A waypoint of a retreat counts as passed within this distance, in metres.
const PASSED_M: f32 = 0.1;

/// An approach by less than this is no progress, in metres.
const PROGRESS_M: f32 = 0.05;

/// A retreating robot ignores robots farther away than this, in metres.
const CROWD_RANGE_M: f32 = 25.0;

/// Distance between the points at which a retreat is compared with the other robot's route, in metres.
const SAMPLE_M: f32 = 0.4;

/// Robots within this distance of a robot that makes room may pass it in the same platoon, in metres.
const PLATOON_M: f32 = 5.0;

/// Robots go in the same direction if the cosine between their preferred velocities is larger than this.
const PLATOON_COS: f32 = 0.5;

/// The robots of a step, and the rules by which they make room.
pub(super) struct Crowd<'c, 'm> {
    pub(super) rules: &'c RetreatModel,
    pub(super) movers: &'c [Mover<'m>],
    pub(super) neighbours: &'c Neighbours,
}

/// One robot that makes room.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Retreat {
    /// The robot for which it makes room.
    pub(super) head: usize,
    /// Depth in the chain: 1 if `head` does not retreat itself, otherwise one more than the depth of `head`.
    pub(super) depth: u32,
    /// Waypoints to the place, the next one last; empty at the place.
    path: Vec<Vector>,
    /// Points of the whole trajectory, from the place where the robot was in the way to the place where it
    /// makes room, at short distances.
    line: Vec<Vector>,
    least_left: f32,
    idle_steps: u32,
    /// Steps since the retreat began. The count continues when the retreat passes on to another head.
    held_steps: u32,
}

/// All retreats, by robot.
#[derive(Default, Serialize, Deserialize)]
pub(super) struct Retreats {
    of: BTreeMap<usize, Retreat>,
    /// For each robot, steps during which it is not asked again.
    respite: Vec<u32>,
}

impl Retreats {
    /// The robots that make room, in order of their indices.
    pub(super) fn iter(&self) -> impl Iterator<Item = (usize, &Retreat)> {
        self.of.iter().map(|(i, retreat)| (*i, retreat))
    }

    /// The robot for which this one makes room.
    pub(super) fn head_of(&self, i: usize) -> Option<usize> {
        self.of.get(&i).map(|retreat| retreat.head)
    }

    /// Depth of a robot in its chain: 0 for a robot that does not retreat.
    pub(super) fn depth(&self, i: usize) -> u32 {
        self.of.get(&i).map_or(0, |retreat| retreat.depth)
    }

    /// Whether a robot deeper in the chain is on its way to make room for this robot. Only deeper robots
    /// count, so that the patience of a chain ends.
    pub(super) fn is_served(&self, i: usize) -> bool {
        let depth = self.depth(i);
        let serves = |other: &Retreat| other.head == i && other.depth > depth && !other.path.is_empty();
        self.of.values().any(serves)
    }

    /// Whether a robot makes room for another one, or for a robot that makes room for that one, and so on.
    pub(super) fn serves(&self, i: usize, other: usize) -> bool {
        let heads = std::iter::successors(self.head_of(i), |head| self.head_of(*head));
        heads.take(MAX_DEPTH as usize).any(|head| head == other)
    }

    fn is_at_place(&self, i: usize) -> bool {
        self.of.get(&i).is_some_and(|retreat| retreat.path.is_empty())
    }

    /// Ends the retreats that are over. Sets the preferred velocities of the other retreating robots to go to
    /// their places.
    pub(super) fn follow(&mut self, rules: &RetreatModel, movers: &mut [Mover], neighbours: &Neighbours) {
        self.respite.resize(movers.len(), 0);
        self.respite.iter_mut().for_each(|steps| *steps = steps.saturating_sub(1));
        let crowd = Crowd { rules, movers, neighbours };
        let makers: Vec<usize> = self.of.keys().copied().collect();
        for i in makers {
            let is_served = self.is_served(i);
            let Some(mut retreat) = self.of.remove(&i) else { continue };
            retreat.advance(&crowd.movers[i], &crowd.movers[retreat.head], is_served);
            if !self.is_over(i, &retreat, &crowd) {
                self.of.insert(i, retreat);
            } else if let Some(retreat) = self.for_the_next(i, retreat, &crowd) {
                self.of.insert(i, retreat);
            }
        }
        for (i, retreat) in &self.of {
            retreat.guide(&mut movers[*i], rules.speed);
        }
    }

    fn is_over(&self, i: usize, retreat: &Retreat, crowd: &Crowd) -> bool {
        let (me, head, rules) = (&crowd.movers[i], &crowd.movers[retreat.head], crowd.rules);
        let head_way: Vec<Vector> = match self.of.get(&retreat.head) {
            Some(other) => other.way(head),
            None if head.wishes_to_move() => {
                std::iter::once(head.position).chain(head.route.iter().copied()).collect()
            }
            None => return true,
        };
        let apart = me.radius + head.radius + rules.margin;
        !me.can_make_room
            || retreat.is_out_of_patience(rules)
            || retreat.is_passed(&head_way, apart)
            || rules.goes_on_within.is_some_and(|within| {
                !retreat.only_goes_back(me, apart) && is_clear_ahead(me, within, &head_way, apart)
            })
    }

    /// Passes a retreat on to the nearest robot that follows the robot that passed. So robots go through a
    /// narrow passage in platoons, not one at a time from either side. `None` if no robot follows, or if the
    /// retreat has lasted too long.
    fn for_the_next(&self, i: usize, mut retreat: Retreat, crowd: &Crowd) -> Option<Retreat> {
        let Crowd { rules, movers, neighbours } = crowd;
        let (me, passed) = (&movers[i], &movers[retreat.head]);
        let direction = passed.preferred.normalize_or_zero();
        let follows = |k: &usize| {
            let other = &movers[*k];
            *k != i
                && *k != retreat.head
                && other.aerial == me.aerial
                && self.depth(*k) == 0
                && other.preferred.normalize_or_zero().dot(direction) > PLATOON_COS
                && !retreat.is_passed(&ways(other)[0], me.radius + other.radius + rules.margin)
        };
        if !me.can_make_room || retreat.is_out_of_patience(rules) || retreat.held_steps > rules.at_place {
            return None;
        }
        let near = |k: &usize| (movers[*k].position - me.position).length();
        let next = neighbours
            .by_x()
            .within(me.position, PLATOON_M)
            .map(|(k, _)| k)
            .filter(follows)
            .min_by(|a, b| near(a).total_cmp(&near(b)).then(a.cmp(b)))?;
        retreat.head = next;
        retreat.depth = 1;
        retreat.idle_steps = 0;
        Some(retreat)
    }

    /// Ends the retreat of a robot as failed, if it retreats. It is not asked again for `respite` steps.
    pub(super) fn give_up(&mut self, i: usize, respite: u32) {
        if self.of.remove(&i).is_some() {
            self.respite[i] = respite;
        }
    }

    /// Has `blocker` make room for `i`. Returns whether it does: it must be in the way, and there must be a
    /// place to go.
    pub(super) fn make_room(&mut self, i: usize, blocker: usize, crowd: &Crowd, log: &mut EventLog) -> bool {
        if !self.may_ask(i, blocker, crowd.movers) {
            return false;
        }
        let Some(path) = self.find_room(i, blocker, crowd) else { return false };
        let retreat = Retreat {
            head: i,
            depth: self.depth(i) + 1,
            line: sampled(crowd.movers[blocker].position, &path),
            path: path.into_iter().rev().collect(),
            least_left: f32::INFINITY,
            idle_steps: 0,
            held_steps: 0,
        };
        let is_in_the_way = !self.is_over(blocker, &retreat, crowd);
        if is_in_the_way {
            self.of.insert(blocker, retreat);
            let [robot, room_for] = [blocker, i].map(|i| crowd.movers[i].robot);
            log.push(Event::MadeRoom { robot, room_for });
        }
        is_in_the_way
    }

    /// Whether `i` may ask `blocker` to make room. The blocker must be able to make room and not be in its
    /// respite. The chain must not be too long. A blocker that is deeper in a chain than `i` is asked only
    /// once it is at its place.
    fn may_ask(&self, i: usize, blocker: usize, movers: &[Mover]) -> bool {
        movers[blocker].can_make_room
            && self.respite[blocker] == 0
            && self.depth(i) < MAX_DEPTH
            && (self.depth(blocker) <= self.depth(i) || self.is_at_place(blocker))
    }

    fn find_room(&self, i: usize, blocker: usize, crowd: &Crowd) -> Option<Vec<Vector>> {
        let Crowd { rules, movers, neighbours } = crowd;
        let (me, head) = (&movers[blocker], &movers[i]);
        let others = || {
            let near = neighbours.by_x().within(me.position, CROWD_RANGE_M).map(|(k, _)| (k, &movers[k]));
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
            margin: rules.margin,
            leaves_out_corners: rules.leaves_out_corners,
            arena: rules.arena,
        };
        ask.find().or_else(|| {
            ask.way.extend(behind); // both would have to get out of here: off the whole way of `head`
            ask.through_head = true;
            ask.find()
        })
    }
}

/// Whether another robot's path keeps this distance, in metres, from a robot and from the next `within`
/// metres of its route. `false` for a robot without a route.
fn is_clear_ahead(me: &Mover, within: f32, other_way: &[Vector], apart: f32) -> bool {
    let count = 1 + (within / SAMPLE_M).ceil() as usize;
    let legs = me.route.len().min(count); // each leg has a point at least
    let points = sampled(me.position, &me.route[..legs]);
    !me.route.is_empty() && points.iter().take(count).all(|point| keeps_apart(*point, other_way, apart))
}

/// Whether a path keeps nearly this distance, in metres, from a point.
fn keeps_apart(point: Vector, way: &[Vector], apart: f32) -> bool {
    distance_to_way(point, way) > 0.95 * apart
}

/// Points along a path, at most `SAMPLE_M` apart.
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
    fn is_out_of_patience(&self, rules: &RetreatModel) -> bool {
        self.idle_steps > if self.path.is_empty() { rules.at_place } else { rules.underway }
    }

    /// Whether the robot is underway and has come no nearer to its place for more than so many steps.
    pub(super) fn is_held_up(&self, steps: u32) -> bool {
        !self.path.is_empty() && self.idle_steps > steps
    }

    /// The path from the robot's position to the place.
    fn way(&self, me: &Mover) -> Vec<Vector> {
        std::iter::once(me.position).chain(self.path.iter().rev().copied()).collect()
    }

    /// Whether the other robot's path keeps this distance, in metres, from the whole line of the retreat.
    fn is_passed(&self, head_way: &[Vector], apart: f32) -> bool {
        self.line.iter().all(|point| keeps_apart(*point, head_way, apart))
    }

    /// Whether the robot's route ends where it was in the way: then it stays at its place until the other has
    /// passed. It would only be in the way again.
    fn only_goes_back(&self, me: &Mover, apart: f32) -> bool {
        let asked_at = self.line.first();
        asked_at.zip(me.route.last()).is_some_and(|(asked, goal)| (*goal - *asked).length() < apart)
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

    /// Sets the robot's preferred velocity: to go to the place where it makes room, or to stay there.
    fn guide(&self, me: &mut Mover, speed_share: f32) {
        let Some(next) = self.path.last() else {
            me.preferred = Vector::ZERO;
            return;
        };
        let to_next = *next - me.position;
        me.retreat_left = Some(self.way(me).windows(2).map(|leg| (leg[1] - leg[0]).length()).sum());
        me.leg_left = to_next.length();
        let reachable = me.brakes.speed_before(0.0, me.leg_left).max(0.05);
        me.preferred = to_next.normalize_or_zero() * (speed_share * me.speed).min(reachable);
    }
}

#[cfg(test)]
impl Retreats {
    /// Robot `i` is on its way to a place at `to` for its head, and has come no nearer for so many steps.
    pub(super) fn begin_held_up(&mut self, i: usize, head: usize, to: Vector, steps: u32) {
        let (path, line) = (vec![to], vec![to]);
        let retreat =
            Retreat { head, depth: 1, path, line, least_left: 0.0, idle_steps: steps, held_steps: steps };
        self.of.insert(i, retreat);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_robot_goes_on_once_its_route_is_clear_for_a_while() {
        let me = crate::conflict::testing::mover(0, [5.0, 6.0], [1.0, 0.0]);
        let is_clear = |other_way: &[[f32; 2]], within: f32| {
            let way: Vec<Vector> = other_way.iter().copied().map(Vector::from).collect();
            is_clear_ahead(&me, within, &way, 0.8)
        };
        assert!(is_clear(&[[4.0, 5.0], [0.0, 5.0]], 3.0), "the other robot has passed");
        assert!(!is_clear(&[[6.0, 5.5], [0.0, 5.5]], 3.0), "it has still to pass");
        assert!(is_clear(&[[12.0, 6.0], [12.0, 9.0]], 3.0), "it crosses the route farther on");
        assert!(!is_clear(&[[12.0, 6.0], [12.0, 9.0]], 8.0), "and that counts if it is within the distance");
        let parked = Mover { route: &[], ..me };
        assert!(!is_clear_ahead(&parked, 3.0, &[Vector::ZERO], 0.8), "a robot without a route stays");
    }

    #[test]
    fn a_robot_serves_all_robots_up_its_chain() {
        let retreat = |head| Retreat {
            head,
            depth: 1,
            path: Vec::new(),
            line: Vec::new(),
            least_left: f32::INFINITY,
            idle_steps: 0,
            held_steps: 0,
        };
        let mut retreats = Retreats::default();
        retreats.of.insert(2, retreat(1));
        retreats.of.insert(1, retreat(0));
        let serves = |i: usize| (0..3).filter(|other| retreats.serves(i, *other)).collect::<Vec<_>>();
        assert_eq!([serves(0), serves(1), serves(2)], [vec![], vec![0], vec![0, 1]]);
    }
}
