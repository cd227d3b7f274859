//! Narrow passages on a route: where two robots do not fit side by side.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use super::obstacles::{KnownObstacle, contains, crosses, nearest_border_point};
use super::{ObstacleMap, Route};

/// Least distance between two places of a route at which its width is examined, in metres.
const SAMPLE_M: f32 = 0.15;

/// The obstacles near a route are looked up for so much of it at a time, in metres.
const STRETCH_M: f32 = 8.0;

/// A route is examined when less than this of it is examined ahead, in metres, and then for twice as far.
const AHEAD_M: f32 = 10.0;

/// A route is not left half examined within this distance of a passage, in metres: what follows may be part
/// of the passage, or a bay beside it.
const BEYOND_M: f32 = 3.0;

/// Room that two robots side by side need beyond their diameters, in metres.
const SPARE_M: f32 = 0.05;

/// A recess beside the route is a bay if it ends within this distance, in metres. A longer opening is another
/// route, on which other robots may come.
const BAY_DEPTH_M: f32 = 2.0;

/// An obstacle narrows a route only if the sine between its direction and the route's is larger than this.
/// Otherwise it lies ahead or behind.
const ASIDE: f32 = 0.5;

/// A part of a route where two robots do not fit side by side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Passage {
    /// Points of the route through the passage, from its beginning to its end.
    pub points: Vec<Vector>,
    /// Route length left at the beginning of the passage, in metres.
    pub enters_at: f32,
    /// Route length left at the end of the passage, in metres.
    pub leaves_at: f32,
}

/// The narrow passages of a route, as far as it was examined.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Passages {
    /// In the order in which the route leads through them.
    pub(crate) found: Vec<Passage>,
    /// Route length left at the place up to which it was examined, in metres.
    examined_to: f32,
}

impl Default for Passages {
    /// Nothing was examined.
    fn default() -> Self {
        Self { found: Vec::new(), examined_to: f32::INFINITY }
    }
}

impl Passages {
    /// Whether the last passage ends a short way before the place at which this much of the route is left, in
    /// metres.
    fn are_near(&self, left: f32) -> bool {
        self.found.last().is_some_and(|last| last.leaves_at - left < BEYOND_M)
    }
}

/// The surroundings that make a route narrow.
pub struct Walls<'a> {
    /// The obstacles that are known.
    pub known: &'a ObstacleMap,
    /// Width and height of the arena, in metres.
    pub arena: Vector,
    /// The robot's radius, in metres.
    pub radius: f32,
}

impl Walls<'_> {
    /// Examines more of a route once the robot comes near to what was not examined. `left` is the length of
    /// the route from the position `from`, in metres.
    pub(crate) fn examine(&self, from: Vector, left: f32, route: &Route, passages: &mut Passages) {
        if passages.examined_to <= (left - AHEAD_M).max(0.0) {
            return;
        }
        let mut near: Vec<&KnownObstacle> = Vec::new();
        let mut rest = left;
        for (a, b) in route.legs(from) {
            let length = (b - a).length();
            let along = (b - a).normalize_or_zero();
            let mut at = (rest - passages.examined_to).max(0.0);
            let mut looked_to = at;
            while at < length {
                let (point, here) = (a + along * at, rest - at);
                if here < left - 2.0 * AHEAD_M && !passages.are_near(here) {
                    passages.examined_to = here;
                    return;
                }
                if at >= looked_to {
                    looked_to = at + STRETCH_M;
                    near.clear();
                    near.extend(self.known.beside(point, point + along * STRETCH_M, self.range()));
                }
                let (is_narrow, skip) = self.look(point, along, &near);
                if is_narrow {
                    self.add(&mut passages.found, point, here);
                }
                at += skip.max(SAMPLE_M);
            }
            rest -= length;
        }
        passages.examined_to = 0.0;
    }

    /// Adds a narrow point to the last passage. After a wide place that is longer than the robot's radius,
    /// begins another passage: a shorter one is no place to let others pass.
    fn add(&self, passages: &mut Vec<Passage>, point: Vector, left: f32) {
        match passages.last_mut() {
            Some(last) if last.leaves_at - left < self.radius.max(1.5 * SAMPLE_M) => {
                last.points.push(point);
                last.leaves_at = left;
            }
            _ => passages.push(Passage { points: vec![point], enters_at: left, leaves_at: left }),
        }
    }

    /// Room that two robots need side by side, in metres.
    fn needed(&self) -> f32 {
        2.0 * self.radius + SPARE_M
    }

    /// Distance from a point within which obstacles matter there, in metres.
    fn range(&self) -> f32 {
        (2.0 * self.needed()).max(BAY_DEPTH_M)
    }

    /// Whether a route in this direction is narrow at a point, and the distance from the point within which
    /// it is not, in metres. All obstacles that matter are in `near`.
    fn look(&self, point: Vector, along: Vector, near: &[&KnownObstacle]) -> (bool, f32) {
        let (needed, range) = (self.needed(), self.range());
        let mut gaps = [f32::INFINITY; 2];
        let mut nearest = f32::INFINITY;
        let mut note = |offset: Vector| {
            let gap = offset.length();
            nearest = nearest.min(gap);
            let aside = along.perp_dot(offset / gap.max(1e-6));
            if aside.abs() > ASIDE {
                let side = &mut gaps[usize::from(aside > 0.0)];
                *side = side.min(gap);
            }
        };
        let (low, high) = (Vector::splat(self.radius), self.arena - Vector::splat(self.radius));
        note(Vector::new(low.x - point.x, 0.0));
        note(Vector::new(high.x - point.x, 0.0));
        note(Vector::new(0.0, low.y - point.y));
        note(Vector::new(0.0, high.y - point.y));
        let near = || near.iter().filter(|obstacle| obstacle.may_reach(point, range));
        near().for_each(|obstacle| note(offset(obstacle, point)));
        let is_inside = |to: Vector| to.cmpge(low).all() && to.cmple(high).all();
        let is_free =
            |to: Vector| is_inside(to) && !near().any(|obstacle| crosses(&obstacle.tight, point, to));
        let is_bay = |side: Vector| is_free(point + side * needed) && !is_free(point + side * BAY_DEPTH_M);
        let is_narrow = gaps[0] + gaps[1] < needed && !is_bay(along.perp()) && !is_bay(-along.perp());
        (is_narrow, nearest.min(2.0 * needed) - needed)
    }
}

/// The vector from a point to the border of an obstacle. From a point inside, a short vector inwards.
fn offset(obstacle: &KnownObstacle, point: Vector) -> Vector {
    let to_border = nearest_border_point(&obstacle.tight, point) - point;
    if contains(&obstacle.tight, point) { -to_border.normalize_or_zero() * 1e-3 } else { to_border }
}
