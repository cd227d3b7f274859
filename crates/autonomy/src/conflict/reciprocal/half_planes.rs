//! The velocity nearest to a preferred velocity that satisfies a set of half-planes and a top speed.
//!
//! The incremental linear programs of ORCA (van den Berg, Guy, Lin & Manocha, "Reciprocal n-Body Collision
//! Avoidance", 2011, section 5). Half-planes of walls come first and are satisfied whenever that is possible.
//! If the half-planes of the robots leave no velocity, the solver minimizes the worst violation among them.
//! O(n) on average, O(n^2) at worst.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

/// Two borders are parallel if the cross product of their directions is smaller than this.
const PARALLEL: f32 = 1e-5;

/// A velocity faster than the top speed by more than this factor comes of rounding: borders that are nearly
/// parallel meet far away.
const TOO_FAST: f32 = 1.001;

/// Velocities on the left of a line through `point` along the unit vector `direction`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct HalfPlane {
    /// A velocity on the border, in metres per second.
    pub(super) point: Vector,
    /// Along the border.
    pub(super) direction: Vector,
}

impl HalfPlane {
    /// Velocities whose component along a unit vector is at least this, in metres per second.
    pub(super) fn at_least(speed: f32, along: Vector) -> Self {
        Self { point: along * speed, direction: -along.perp() }
    }

    /// Whether a velocity lies in the half-plane.
    pub(super) fn holds(&self, velocity: Vector) -> bool {
        self.excess(velocity) <= 0.0
    }

    /// How far a velocity lies outside the half-plane, in metres per second; negative inside.
    fn excess(&self, velocity: Vector) -> f32 {
        self.direction.perp_dot(self.point - velocity)
    }
}

/// The objective of the linear program.
#[derive(Clone, Copy)]
enum Aim {
    /// The velocity nearest to this one.
    Near(Vector),
    /// The velocity that goes farthest along this unit vector.
    Along(Vector),
}

/// The velocity nearest to `preferred`, of at most `top_speed`, that satisfies all half-planes. If none does,
/// the first `walls` half-planes take precedence over the others.
pub(super) fn best_velocity(planes: &[HalfPlane], walls: usize, preferred: Vector, top_speed: f32) -> Vector {
    let best = match solve(planes, Aim::Near(preferred), top_speed) {
        Ok(velocity) => velocity,
        Err((failed, velocity)) => least_bad(planes, walls, failed, velocity, top_speed),
    };
    let is_too_fast = best.length() > TOO_FAST * top_speed;
    if is_too_fast { best.clamp_length_max(top_speed) } else { best }
}

/// The best velocity. If the half-planes leave none, the number of the first half-plane that cannot be
/// satisfied, and the best velocity that satisfies the half-planes before it.
fn solve(planes: &[HalfPlane], aim: Aim, top_speed: f32) -> Result<Vector, (usize, Vector)> {
    let mut best = match aim {
        Aim::Near(preferred) => preferred.clamp_length_max(top_speed),
        Aim::Along(direction) => direction * top_speed,
    };
    for (at, plane) in planes.iter().enumerate() {
        if plane.excess(best) > 0.0 {
            best = on_border(planes, at, aim, top_speed).ok_or((at, best))?;
        }
    }
    Ok(best)
}

/// The best velocity on the border of one half-plane that satisfies the half-planes before it.
fn on_border(planes: &[HalfPlane], at: usize, aim: Aim, top_speed: f32) -> Option<Vector> {
    let HalfPlane { point, direction } = planes[at];
    let middle = -point.dot(direction);
    let half_chord_squared = middle * middle + top_speed * top_speed - point.length_squared();
    if half_chord_squared < 0.0 {
        return None;
    }
    let half_chord = half_chord_squared.sqrt();
    let (mut from, mut to) = (middle - half_chord, middle + half_chord);
    for other in &planes[..at] {
        let cross = direction.perp_dot(other.direction);
        let outside = other.excess(point);
        if cross.abs() <= PARALLEL {
            if outside > 0.0 {
                return None;
            }
            continue;
        }
        let meets = -outside / cross;
        if cross > 0.0 {
            to = to.min(meets);
        } else {
            from = from.max(meets);
        }
        if from > to {
            return None;
        }
    }
    let along = match aim {
        Aim::Near(preferred) => (preferred - point).dot(direction).clamp(from, to),
        Aim::Along(wanted) if wanted.dot(direction) > 0.0 => to,
        Aim::Along(_) => from,
    };
    Some(point + direction * along)
}

/// Satisfies the walls and minimizes the worst violation of the other half-planes, from number `failed` on.
fn least_bad(planes: &[HalfPlane], walls: usize, failed: usize, found: Vector, top_speed: f32) -> Vector {
    let mut best = found;
    let mut worst = 0.0;
    let mut lifted: Vec<HalfPlane> = Vec::with_capacity(planes.len());
    for at in failed.max(walls)..planes.len() {
        let plane = &planes[at];
        if plane.excess(best) <= worst {
            continue;
        }
        lifted.clear();
        lifted.extend(&planes[..walls]);
        lifted.extend(planes[walls..at].iter().filter_map(|other| equally_bad(plane, other)));
        if let Ok(velocity) = solve(&lifted, Aim::Along(plane.direction.perp()), top_speed) {
            best = velocity;
        }
        worst = plane.excess(best);
    }
    best
}

/// The velocities that violate `plane` at least as much as `other`. `None` if the two are parallel and point
/// in the same direction.
fn equally_bad(plane: &HalfPlane, other: &HalfPlane) -> Option<HalfPlane> {
    let cross = plane.direction.perp_dot(other.direction);
    let point = if cross.abs() > PARALLEL {
        plane.point + plane.direction * (-other.excess(plane.point) / cross)
    } else if plane.direction.dot(other.direction) > 0.0 {
        return None;
    } else {
        (plane.point + other.point) * 0.5
    };
    Some(HalfPlane { point, direction: (other.direction - plane.direction).normalize_or_zero() })
}
