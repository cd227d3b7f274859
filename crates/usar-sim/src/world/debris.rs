//! Debris: convex pieces, fixed or movable.

use parry2d::bounding_volume::Aabb;
use parry2d::math::{Pose, Vector};
use serde::{Deserialize, Serialize};

use crate::geometry::Outline;
use crate::scenario::DebrisFile;

/// A pushed piece is noticed once it lies this far, in metres, from where it was last seen.
const NOTICED_MOVE_M: f32 = 0.2;

/// Position of absent pieces, in metres: far from every arena.
const AWAY: Vector = Vector::new(-20_000.0, -20_000.0);

/// A piece of debris in the world.
#[derive(Clone, Serialize, Deserialize)]
pub struct Debris {
    /// Where it is.
    pub outline: Outline,
    /// Whether nothing can push it.
    #[serde(skip)]
    pub is_fixed: bool,
    /// Whether events place or remove it.
    #[serde(skip)]
    pub is_gate: bool,
    /// Distance from its centre within which the whole piece lies, in metres.
    #[serde(skip)]
    pub reach: f32,
    /// The outlines that robots may have seen: the initial one if the piece was there, and one more each time
    /// that it was pushed noticeably or that an event moved it.
    pub sightings: Vec<Outline>,
    /// For each of these outlines, the step from which on it could be seen.
    pub since: Vec<u64>,
}

impl Debris {
    /// A piece at its initial place.
    #[must_use]
    pub fn new(file: &DebrisFile) -> Self {
        let outline = file.outline();
        let bounds = outline.shape.compute_local_bounding_sphere();
        let reach = bounds.center.length() + bounds.radius;
        let (is_fixed, sightings) = (file.movable.is_none(), vec![outline.clone()]);
        Self { is_fixed, is_gate: false, sightings, since: vec![0], reach, outline }
    }

    /// A piece that events place or remove; `is_there` tells whether it is there at the start.
    #[must_use]
    pub fn gate(file: &DebrisFile, is_there: bool) -> Self {
        let mut piece = Self { is_gate: true, ..Self::new(file) };
        if !is_there {
            piece.sightings.clear();
            piece.since.clear();
            piece.outline.pose.translation = AWAY;
        }
        piece
    }

    /// Whether the piece is in the arena.
    #[must_use]
    pub fn is_there(&self) -> bool {
        self.outline.pose.translation != AWAY
    }

    /// Puts the piece to a place, or away. Adds a sighting, so that passing robots notice the change.
    pub(super) fn put(&mut self, pose: Option<Pose>, step: u64) {
        match pose {
            Some(pose) => self.outline.pose = pose,
            None => self.outline.pose.translation = AWAY,
        }
        self.note_sighting(step);
    }

    /// Restores the fields that a snapshot leaves out: they are fixed.
    pub(super) fn restore(&mut self, file: &DebrisFile) {
        let Self { outline, is_fixed, reach, .. } = Self::new(file);
        (self.is_fixed, self.reach) = (is_fixed, reach);
        let places = self.sightings.iter_mut().chain([&mut self.outline]);
        places.for_each(|place| place.shape = outline.shape.clone());
    }

    /// The bounding box of the piece.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.outline.shape.compute_aabb(&self.outline.pose)
    }

    fn note_sighting(&mut self, step: u64) {
        self.sightings.push(self.outline.clone());
        self.since.push(step);
    }

    /// How many of the sightings could be made up to a step, that step included.
    #[must_use]
    pub fn sightings_until(&self, step: u64) -> usize {
        self.since.partition_point(|since| *since <= step)
    }

    /// Takes a new pose from the physics.
    pub(super) fn moved_to(&mut self, pose: Pose, step: u64) {
        self.outline.pose = pose;
        let seen = &self.sightings[self.sightings.len() - 1].pose;
        let arm = self.outline.shape.compute_local_bounding_sphere().radius;
        let turned =
            Vector::new(pose.rotation.cos() - seen.rotation.cos(), pose.rotation.sin() - seen.rotation.sin());
        let moved = (seen.translation - pose.translation).length() + arm * turned.length();
        if moved > NOTICED_MOVE_M {
            self.note_sighting(step);
        }
    }
}
