//! The trail of a robot: the places that it passed.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

/// Distance between two points of a trail, in metres.
const SPACING_M: f32 = 0.5;

/// Least number of points that a full trail keeps; it holds at most twice as many.
const KEPT: usize = 60;

/// The last 30 m or more of a robot's trajectory.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Trail {
    points: Vec<Vector>,
}

impl Trail {
    /// Notes the robot's position, if it is far enough from the last point.
    pub(super) fn note(&mut self, position: Vector) {
        let is_far = |last: &Vector| (*last - position).length_squared() >= SPACING_M * SPACING_M;
        if self.points.last().is_none_or(is_far) {
            if self.points.len() == 2 * KEPT {
                self.points.drain(..KEPT);
            }
            self.points.push(position);
        }
    }

    /// The points, the latest last.
    pub(super) fn points(&self) -> &[Vector] {
        &self.points
    }
}
