//! What a belief holds of each thing, and as of when.

use parry2d::math::{Pose, Vector};
use parry2d::shape::SharedShape;
use scenario::shapes::{Outline, RadiationZone};
use serde::{Deserialize, Serialize};

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

impl KnownRescuee {
    /// All that is known of it, to be hashed. No place has these greatest words.
    pub(super) fn words(&self) -> [u32; 5] {
        let [x, y] = self.waits_at.map_or([u32::MAX; 2], |at| at.to_array().map(f32::to_bits));
        [x, y, self.at_step as u32, (self.at_step >> u32::BITS) as u32, self.sd_m.to_bits()]
    }
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
