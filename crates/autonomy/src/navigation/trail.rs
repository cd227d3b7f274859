//! The trail of a robot: the places that it passed.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use crate::hash::part_of_many;

/// Distance between two points of a trail, in metres.
const SPACING_M: f32 = 0.5;

/// Least number of points that a full trail keeps: more than 30 m, the longest way that anyone looks back.
const KEPT: usize = 62;

/// Points by which a trail exceeds that number before they are dropped at once.
const SURPLUS: usize = 8;

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
            if self.points.len() >= KEPT + SURPLUS {
                self.points.drain(..self.points.len() - KEPT);
            }
            self.points.push(position);
        }
    }

    /// The hash of its points.
    pub(super) fn digest(&self) -> u128 {
        part_of_many(self.points.iter().map(|point| point.to_array().map(f32::to_bits)))
    }

    /// The points, the latest last.
    pub(super) fn points(&self) -> &[Vector] {
        &self.points
    }
}
