//! Passing at a tangent: the free direction nearest to the preferred one, past robots that stand and clear of
//! known debris.

use parry2d::math::Vector;
use smallvec::SmallVec;

use super::Mover;
use crate::planning::{KnownObstacle, ObstacleMap, outward_normal, polygon_contains, polygon_crossed};

/// How far ahead a robot looks for standing robots in its way, in metres.
pub const PASSING_RANGE_M: f32 = 2.0;

/// How far ahead a robot that leaves its route looks for debris, in metres.
const DEBRIS_RANGE_M: f32 = 1.0;

/// Tangents are taken to discs larger by this factor, so that rounding does not make them touch.
const TANGENT_SLACK: f32 = 1.01;

/// A direction is free of an obstacle that is already too close if the cosine of the angle between them is at
/// most this.
const SLIDE: f32 = 0.02;

/// Weight of the direction of the last step, against 1 for the preferred direction.
const PERSISTENCE: f32 = 0.3;

/// Least advance of a direction (cosine to the preferred direction) for it to lead past an obstacle.
const LEAST_ADVANCE: f32 = -0.3;

/// What a robot has to pass.
pub(super) struct Surroundings<'a> {
    /// The preferred velocity, in metres per second.
    pub(super) preferred: Vector,
    /// Robots that stand or yield: their centres relative to this robot, and the distances at which they
    /// touch it.
    pub(super) discs: SmallVec<[(Vector, f32); 16]>,
    /// Distance to keep from these robots beyond touching, in metres.
    pub(super) margin: f32,
    /// Debris that the robot knows; none for a robot that flies.
    pub(super) known: Option<&'a ObstacleMap>,
    /// The direction that the robot took in the last step; zero if it stood.
    pub(super) heading: Vector,
}

/// Pieces of debris that are near enough for a collision.
type Near<'a> = SmallVec<[&'a KnownObstacle; 16]>;

impl<'a> Surroundings<'a> {
    /// Debris with which a robot at this point may collide within [`DEBRIS_RANGE_M`], in order of its keys.
    /// The order decides among equally good directions.
    fn debris(&self, from: Vector) -> Near<'a> {
        let mut near: Near =
            self.known.into_iter().flat_map(|known| known.near(from, DEBRIS_RANGE_M)).collect();
        near.sort_unstable_by_key(|obstacle| obstacle.key);
        near
    }

    /// Whether a robot at `from` can go `range` metres in a direction.
    fn is_free(&self, debris: &Near, from: Vector, direction: Vector, range: f32) -> bool {
        let clear_of_discs = self.discs.iter().all(|(center, touch)| {
            let distance = touch + self.margin;
            if center.length_squared() < distance * distance {
                return direction.dot(*center) <= SLIDE * center.length(); // already too close: not nearer
            }
            let nearest = center.dot(direction).clamp(0.0, range);
            (*center - direction * nearest).length_squared() >= distance * distance
        });
        let to = from + direction * range.min(DEBRIS_RANGE_M);
        clear_of_discs
            && debris.iter().all(|obstacle| match outward(obstacle, from) {
                Some(outward) => direction.dot(outward) >= -SLIDE, // already too close: not nearer
                None => !polygon_crossed(&obstacle.tight, from, to),
            })
    }

    /// How good a free direction is. A direction near the preferred one is good, and so is one near the
    /// direction of the last step: a robot should not dither between two sides.
    fn merit(&self, direction: Vector, preferred: Vector) -> f32 {
        direction.dot(preferred) + PERSISTENCE * direction.dot(self.heading)
    }
}

/// Directions along, and away from, the debris that is too close to a robot.
fn along_debris(debris: &Near, from: Vector) -> impl Iterator<Item = Vector> {
    let outward = debris.iter().filter_map(move |obstacle| outward(obstacle, from));
    outward.flat_map(|outward| [outward.perp(), -outward.perp(), outward])
}

/// The direction that leads out of an obstacle's inflated outline; `None` for a robot outside it.
fn outward(obstacle: &KnownObstacle, from: Vector) -> Option<Vector> {
    polygon_contains(&obstacle.tight, from).then(|| outward_normal(&obstacle.tight, from))
}

/// The best free direction: the preferred direction itself, a tangent to a robot in the way, or a direction
/// along debris. `None` if no direction is free.
pub(super) fn passing_direction(me: &Mover, surroundings: &Surroundings) -> Option<Vector> {
    let preferred = surroundings.preferred.normalize_or_zero();
    let range = PASSING_RANGE_M.min(me.leg_left); // the route bends there
    let margin = surroundings.margin;
    let near = |(center, touch): &&(Vector, f32)| center.length() < range + touch + margin;
    if !surroundings.discs.iter().any(|disc| near(&disc)) {
        return Some(preferred); // the route already keeps clear of debris
    }
    let tangents =
        surroundings.discs.iter().filter(near).flat_map(|(center, touch)| tangents(*center, touch + margin));
    let debris = surroundings.debris(me.position);
    std::iter::once(preferred)
        .chain(tangents)
        .chain(along_debris(&debris, me.position))
        .filter(|direction| direction.dot(preferred) > LEAST_ADVANCE)
        .filter(|direction| surroundings.is_free(&debris, me.position, *direction, range))
        .max_by(|a, b| surroundings.merit(*a, preferred).total_cmp(&surroundings.merit(*b, preferred)))
}

/// The number of the nearest disc (its number, its centre relative to the robot, and the distance at which it
/// touches) in the way of a preferred velocity; the lowest of equally near ones.
pub(super) fn nearest_in_the_way(
    preferred: Vector,
    margin: f32,
    discs: impl Iterator<Item = (usize, Vector, f32)>,
) -> Option<usize> {
    let preferred = preferred.normalize_or_zero();
    let gap = |center: Vector, touch: f32| {
        let ahead = center.dot(preferred);
        let aside = (center - preferred * ahead).length();
        let gap = center.length() - touch;
        (ahead > 0.0 && aside < touch + margin && gap < PASSING_RANGE_M).then_some(gap)
    };
    let gaps = discs.filter_map(|(number, center, touch)| Some((number, gap(center, touch)?)));
    gaps.min_by(|(m, a), (n, b)| a.total_cmp(b).then(m.cmp(n))).map(|(number, _)| number)
}

/// Directions from the origin that touch a disc on its right and on its left.
fn tangents(center: Vector, radius: f32) -> [Vector; 2] {
    let distance = center.length().max(1e-6);
    let toward = center / distance;
    let sin = (radius * TANGENT_SLACK / distance).min(1.0);
    let cos = (1.0 - sin * sin).sqrt();
    let turned = |sin: f32| Vector::new(toward.x * cos - toward.y * sin, toward.x * sin + toward.y * cos);
    [turned(-sin), turned(sin)]
}

#[cfg(test)]
mod tests {
    use super::super::testing::mover;
    use super::*;

    fn pass(discs: &[([f32; 2], f32)]) -> Option<Vector> {
        let discs = discs.iter().map(|(center, radius)| (Vector::from(*center), *radius)).collect();
        let me = mover(0, [0.0, 0.0], [1.0, 0.0]);
        let (preferred, heading) = (me.preferred, Vector::ZERO);
        passing_direction(&me, &Surroundings { preferred, discs, margin: 0.0, known: None, heading })
    }

    #[test]
    fn a_free_wish_is_granted() {
        assert_eq!(pass(&[]), Some(Vector::X));
        assert_eq!(pass(&[([0.0, 2.0], 0.9), ([-1.0, 0.0], 0.9)]), Some(Vector::X));
    }

    #[test]
    fn a_robot_in_the_way_is_passed_at_a_tangent() {
        let direction = pass(&[([1.5, 0.1], 0.9)]).unwrap();
        assert!(direction.y < -0.3, "on the side where there is more room");
        let nearest = (Vector::new(1.5, 0.1) - direction * direction.dot(Vector::new(1.5, 0.1))).length();
        assert!((0.9..0.93).contains(&nearest), "{nearest}");
    }

    #[test]
    fn a_robot_that_is_too_close_is_left_and_a_ring_of_robots_blocks() {
        assert!(pass(&[([0.5, 0.0], 0.9)]).unwrap().x.abs() < 0.05);
        let ring: Vec<_> = (0..8)
            .map(|i| {
                let angle = i as f32 * std::f32::consts::FRAC_PI_4;
                ([1.2 * libm::cosf(angle), 1.2 * libm::sinf(angle)], 0.9)
            })
            .collect();
        assert_eq!(pass(&ring), None);
    }
}
