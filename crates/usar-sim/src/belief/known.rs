//! What a belief holds of each thing, and as of when.

use parry2d::math::{Pose, Vector};
use parry2d::shape::SharedShape;
use serde::{Deserialize, Serialize};

use crate::geometry::{Outline, RadiationZone};
use crate::scenario::Scenario;

/// A piece of debris, as reported.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct KnownDebris {
    /// Its shape.
    pub shape: SharedShape,
    /// Its place.
    pub pose: Pose,
    /// The step of the last report.
    pub at_step: u64,
    /// Standard deviation of its place, in metres.
    pub sd_m: f32,
}

impl KnownDebris {
    /// The shape at its place.
    #[must_use]
    pub fn outline(&self) -> Outline {
        Outline { shape: self.shape.clone(), pose: self.pose }
    }
}

/// A radiation zone, as reported.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct KnownZone {
    /// Its source and radius.
    pub disc: RadiationZone,
    /// Whether it radiates.
    pub on: bool,
    /// The step of the last report.
    pub at_step: u64,
    /// Standard deviation of its place, in metres.
    pub sd_m: f32,
}

/// A rescuee, as reported.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct KnownRescuee {
    /// Where it waits; none if it no longer waits.
    pub waits_at: Option<Vector>,
    /// The step of the last report.
    pub at_step: u64,
    /// Standard deviation of its place, in metres.
    pub sd_m: f32,
}

/// A robot that has stopped for good, as reported.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct KnownWreck {
    /// Its place.
    pub at: Vector,
    /// Its radius, in metres.
    pub radius: f32,
    /// Whether it is in nobody's way, because it flies.
    pub is_aerial: bool,
    /// The step of the last report.
    pub at_step: u64,
}

/// A task, as reported.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct KnownTask {
    /// Whether it is open: it has begun and not ended.
    pub open: bool,
    /// Number of rescuees that waited there.
    pub waiting: u32,
    /// The step of the last report.
    pub at_step: u64,
}

/// How much obstacles are inflated: by the radius of each class of ground robots, and by their clearance.
#[derive(Debug, Clone, Default)]
pub struct Inflation {
    /// Radii of the classes in ascending order, in metres.
    pub radii: Vec<f32>,
    /// Distance that robots keep from obstacles beyond their radius, in metres.
    pub clearance: f32,
}

impl Inflation {
    /// The inflation for the robots of a scenario.
    #[must_use]
    pub fn of(scenario: &Scenario) -> Self {
        Self {
            radii: scenario.ground_radii_m().iter().map(|radius| *radius as f32).collect(),
            clearance: scenario.planning.clearance_m as f32,
        }
    }
}
