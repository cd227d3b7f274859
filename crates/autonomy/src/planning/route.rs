//! A route: waypoints that a robot passes one after the other.

use parry2d::math::Vector;
use scenario::shapes::RadiationZone;
use serde::{Deserialize, Serialize};

/// A robot has passed a waypoint when it is within this distance, in metres.
const PASSED_M: f32 = 0.25;

/// Waypoints to a goal, and the number of the next one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Route {
    waypoints: Vec<Vector>,
    next: usize,
}

impl Route {
    /// A route along these waypoints; there must be at least one.
    pub fn new(waypoints: Vec<Vector>) -> Self {
        debug_assert!(!waypoints.is_empty());
        Self { waypoints, next: 0 }
    }

    /// Number of the next waypoint.
    pub(crate) fn next(&self) -> usize {
        self.next
    }

    /// Waypoints still to pass; never empty.
    pub fn ahead(&self) -> &[Vector] {
        &self.waypoints[self.next..]
    }

    /// The end of the route.
    pub fn end(&self) -> Vector {
        self.waypoints[self.waypoints.len() - 1]
    }

    /// Skips the waypoints that the robot has passed: it is near them, or beyond them towards the next
    /// waypoint.
    pub fn advance(&mut self, position: Vector) {
        while self.next + 1 < self.waypoints.len() {
            let (at, after) = (self.waypoints[self.next], self.waypoints[self.next + 1]);
            let near = (at - position).length_squared() < PASSED_M * PASSED_M;
            let beyond = (position - at).dot(after - at) > 0.0 && (position - at).length() < 4.0 * PASSED_M;
            if !near && !beyond {
                return;
            }
            self.next += 1;
        }
    }

    /// Length from a position along the waypoints ahead, in metres.
    pub fn length(&self, from: Vector) -> f32 {
        self.legs(from).map(|(a, b)| (b - a).length()).sum()
    }

    /// Length inside a radiation zone, in metres.
    pub fn length_inside(&self, from: Vector, zone: &RadiationZone) -> f32 {
        self.legs(from).map(|(a, b)| zone.length_inside(a, b)).sum()
    }

    /// The straight legs ahead.
    pub fn legs(&self, from: Vector) -> impl Iterator<Item = (Vector, Vector)> + '_ {
        let starts = std::iter::once(from).chain(self.ahead().iter().copied());
        starts.zip(self.ahead().iter().copied())
    }
}
