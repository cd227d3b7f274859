//! News: what a belief heard that concerns routes.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use crate::planning::ObstacleKey;

/// A piece of news that concerns routes.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) enum News {
    /// An obstacle is known at its present place.
    Obstacle(ObstacleKey),
    /// A radiation zone is known to be on.
    Zone(u32),
    /// A place is free again.
    Opening(Opening),
}

/// A place that is free again: a piece of debris was pushed away, or a radiation zone was switched off.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) struct Opening {
    /// Middle of the place.
    pub(super) center: Vector,
    /// Radius round the middle that contains the whole place, in metres.
    pub(super) reach: f32,
}

impl Opening {
    /// A lower bound for the length of any path from `a` to `b` through this place, in metres.
    pub(crate) fn least_way(&self, a: Vector, b: Vector) -> f32 {
        let to_here = |point: Vector| ((point - self.center).length() - self.reach).max(0.0);
        to_here(a) + to_here(b)
    }
}

/// A mark in the news: how much of it has been taken into account.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct Seen {
    pub(super) pool: u32,
    pub(super) news: usize,
}
