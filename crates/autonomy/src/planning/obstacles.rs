//! Obstacles as robots know them, and the plane geometry of inflated convex outlines.

use parry2d::bounding_volume::Aabb;
use parry2d::math::Vector;
use parry2d::shape::SharedShape;
use scenario::shapes::Outline;

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::xxh3_64;

/// A route keeps this distance from a closed zone, in metres, so that it does not graze the zone.
pub(super) const ZONE_MARGIN_M: f32 = 0.1;

/// Points pushed out of an obstacle end up this far outside, in metres.
const PUSH_OUT_M: f32 = 0.02;

/// A line of which no more than this is in a polygon only touches it, in metres.
pub(super) const GRAZE_M: f32 = 1.0e-3;

/// The identity of an obstacle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum ObstacleKey {
    /// Debris of this number.
    Debris(u32),
    /// The robot of this number, which can no longer move.
    Wreck(u32),
}

/// An obstacle that a robot knows.
#[derive(Debug, Clone)]
pub struct KnownObstacle {
    /// Its identity.
    pub key: ObstacleKey,
    /// Hash of the corners of `planned`: equal hashes, equal outlines.
    pub digest: u64,
    /// Corners, anticlockwise, inflated by radius and clearance: routes stay outside this polygon.
    pub planned: Vec<Vector>,
    /// Corners, anticlockwise, inflated by radius and a third of the clearance: a route through this polygon
    /// is cut.
    pub tight: Vec<Vector>,
    bounds: Aabb,
}

impl KnownObstacle {
    /// An outline inflated for robots of `radius` that keep `clearance`, in metres.
    pub fn new(key: ObstacleKey, outline: &Outline, radius: f32, clearance: f32) -> Self {
        let planned = outline.inflated(radius + clearance);
        let tight = outline.inflated(radius + clearance / 3.0);
        let bounds = Aabb::from_points(planned.iter().copied());
        Self { key, digest: digest(&planned), bounds, planned, tight }
    }

    /// A hash of its key and outline.
    pub(super) fn digest_with_key(&self) -> u64 {
        let key = match self.key {
            ObstacleKey::Debris(number) => u64::from(number) << 1,
            ObstacleKey::Wreck(number) => u64::from(number) << 1 | 1,
        };
        xxh3_64(&[self.digest.to_le_bytes(), key.to_le_bytes()].concat())
    }

    /// Whether its inflated outline may reach within this range of a point, in metres.
    pub fn may_reach(&self, point: Vector, range: f32) -> bool {
        (point - point.clamp(self.bounds.mins, self.bounds.maxs)).abs().max_element() <= range
    }

    /// The box that holds `planned`.
    pub(super) fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    /// Whether the obstacle cuts the line from `a` to `b`.
    pub(crate) fn cuts(&self, a: Vector, b: Vector) -> bool {
        let Aabb { mins, maxs } = self.bounds;
        let beside = a.max(b).cmplt(mins).any() || a.min(b).cmpgt(maxs).any();
        !beside && crosses(&self.tight, a, b)
    }

    /// Middle of the corners of `planned`, and the distance of the farthest corner from it, in metres.
    pub(crate) fn middle_and_reach(&self) -> (Vector, f32) {
        let middle = self.planned.iter().copied().sum::<Vector>() / self.planned.len() as f32;
        let distance = |corner: &Vector| (*corner - middle).length();
        (middle, self.planned.iter().map(distance).fold(0.0, f32::max))
    }

    /// A robot that can no longer move, as an obstacle.
    pub(crate) fn wreck(number: u32, at: Vector, own_radius: f32, radius: f32, clearance: f32) -> Self {
        let outline = Outline { shape: SharedShape::ball(own_radius), ..Outline::disc(at, own_radius) };
        Self::new(ObstacleKey::Wreck(number), &outline, radius, clearance)
    }
}

/// Whether a convex polygon (anticlockwise) contains a point.
pub fn contains(polygon: &[Vector], point: Vector) -> bool {
    edges(polygon).all(|(a, b)| (b - a).perp_dot(point - a) >= 0.0)
}

/// Whether the line from `a` to `b` crosses the inside of a convex polygon (anticlockwise). Clips the line by
/// each edge (Cyrus and Beck) and tests whether more than a grazing touch is left.
pub fn crosses(polygon: &[Vector], a: Vector, b: Vector) -> bool {
    let way = b - a;
    let length = way.length();
    let (mut enter, mut leave) = (0.0_f32, 1.0_f32);
    for (p, q) in edges(polygon) {
        let edge = q - p;
        let depth = edge.perp_dot(a - p); // positive inside
        let change = edge.perp_dot(way);
        if change.abs() < 1e-12 {
            if depth <= 0.0 {
                return false;
            }
        } else if change > 0.0 {
            enter = enter.max(-depth / change);
        } else {
            leave = leave.min(-depth / change);
        }
        if enter >= leave {
            return false;
        }
    }
    (leave - enter) * length > GRAZE_M
}

/// The point nearest to `point` that is outside all polygons and `offset` metres inside the arena. Where
/// polygons overlap, a few rounds of pushing give an approximation.
pub(super) fn push_out<P: AsRef<[Vector]>>(
    point: Vector,
    polygons: &[P],
    arena: Vector,
    offset: f32,
) -> Vector {
    let border = Vector::splat(offset + PUSH_OUT_M);
    let inside_arena = |point: Vector| point.max(border).min((arena - border).max(border));
    let mut point = inside_arena(point);
    for _ in 0..8 {
        let Some(polygon) = polygons.iter().find(|polygon| contains(polygon.as_ref(), point)) else {
            return point;
        };
        point = inside_arena(nearest_outside(polygon.as_ref(), point));
    }
    nearest_free_corner(point, polygons, inside_arena)
}

/// The nearest corner that lies outside all polygons, for overlapping polygons between which pushing goes to
/// and fro.
fn nearest_free_corner<P: AsRef<[Vector]>>(
    point: Vector,
    polygons: &[P],
    inside_arena: impl Fn(Vector) -> Vector,
) -> Vector {
    let corners = polygons.iter().flat_map(|polygon| {
        let polygon = polygon.as_ref();
        let middle = polygon.iter().copied().sum::<Vector>() / polygon.len() as f32;
        polygon.iter().map(move |corner| *corner + (*corner - middle).normalize_or_zero() * PUSH_OUT_M)
    });
    corners
        .filter(|corner| inside_arena(*corner) == *corner)
        .filter(|corner| !polygons.iter().any(|polygon| contains(polygon.as_ref(), *corner)))
        .min_by(|a, b| (*a - point).length_squared().total_cmp(&(*b - point).length_squared()))
        .unwrap_or(point)
}

/// The nearest point outside a convex polygon to a point inside it.
fn nearest_outside(polygon: &[Vector], point: Vector) -> Vector {
    let (outward, depth) = nearest_edge(polygon, point);
    point + outward * (depth + PUSH_OUT_M)
}

/// The unit vector of the shortest exit from a convex polygon (anticlockwise) that contains a point.
pub fn outward_normal(polygon: &[Vector], point: Vector) -> Vector {
    nearest_edge(polygon, point).0
}

/// The point on a polygon's border that is nearest to a point.
pub fn nearest_border_point(polygon: &[Vector], point: Vector) -> Vector {
    let on_edge = |(a, b): (Vector, Vector)| {
        let edge = b - a;
        a + edge * ((point - a).dot(edge) / edge.length_squared().max(1e-9)).clamp(0.0, 1.0)
    };
    let distance = |p: &Vector| (*p - point).length_squared();
    edges(polygon).map(on_edge).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(point)
}

/// Outward normal of the nearest edge, and the depth of the point below it, in metres.
fn nearest_edge(polygon: &[Vector], point: Vector) -> (Vector, f32) {
    let mut nearest = (Vector::ZERO, f32::INFINITY);
    for (a, b) in edges(polygon) {
        let outward = Vector::new(b.y - a.y, a.x - b.x).normalize_or_zero();
        let depth = outward.dot(a - point);
        if depth < nearest.1 {
            nearest = (outward, depth);
        }
    }
    nearest
}

/// Hash of the corners of an outline: equal hashes, equal outlines.
pub(super) fn digest(outline: &[Vector]) -> u64 {
    let values = outline.iter().flat_map(|at| [at.x, at.y]);
    xxh3_64(&values.flat_map(|value| value.to_bits().to_le_bytes()).collect::<Vec<u8>>())
}

fn edges(polygon: &[Vector]) -> impl Iterator<Item = (Vector, Vector)> + '_ {
    (0..polygon.len()).map(|i| (polygon[i], polygon[(i + 1) % polygon.len()]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Vec<Vector> {
        [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]].map(Vector::from).to_vec()
    }

    #[test]
    fn ways_through_the_inside_cross_and_grazing_ones_do_not() {
        let way = |a: [f32; 2], b: [f32; 2]| crosses(&square(), a.into(), b.into());
        assert!(way([0.0, 2.0], [4.0, 2.0]));
        assert!(way([2.0, 2.0], [5.0, 5.0]), "from inside");
        assert!(way([0.0, 0.0], [4.0, 4.0]));
        assert!(!way([0.0, 1.0], [4.0, 1.0]), "along an edge");
        assert!(!way([0.0, 2.0], [2.0, 4.0]), "through a corner");
        assert!(!way([0.0, 2.0], [0.9, 2.0]), "ends before");
        assert!(!way([5.0, 5.0], [6.0, 6.0]));
    }

    #[test]
    fn points_are_pushed_out_by_the_shortest_way() {
        let arena = Vector::new(10.0, 10.0);
        let out = push_out(Vector::new(2.0, 1.2), &[square()], arena, 0.5);
        assert!(!contains(&square(), out) && (out - Vector::new(2.0, 1.0)).length() < 0.03, "{out}");
        let other = [[2.5, 1.0], [4.5, 1.0], [4.5, 3.0], [2.5, 3.0]].map(Vector::from).to_vec();
        let overlapping = [square(), other];
        let out = push_out(Vector::new(2.75, 2.0), &overlapping, arena, 0.5);
        assert!(!overlapping.iter().any(|polygon| contains(polygon, out)), "{out}");
        let free = Vector::new(6.0, 6.0);
        assert_eq!(push_out(free, &[square()], arena, 0.5), free);
        assert!(push_out(Vector::new(-1.0, 5.0), &[square()], arena, 0.5).x >= 0.5);
    }
}
