//! Debris: convex pieces, fixed or movable.

use std::ops::Deref;
use std::sync::Arc;

use parry2d::bounding_volume::Aabb;
use parry2d::math::{Pose, Vector};
use scenario::shapes::Outline;
use serde::{Deserialize, Serialize};

use crate::model::DebrisModel;

/// A pushed piece is noticed once it lies this far, in metres, from where it was last seen.
const NOTICED_MOVE_M: f32 = 0.2;

/// Position of absent pieces, in metres: far from every arena.
pub(crate) const AWAY: Vector = Vector::new(-20_000.0, -20_000.0);

/// A piece of debris in the world. It dereferences to its fixed properties, the [`DebrisModel`].
#[derive(Clone, Serialize, Deserialize)]
pub struct Debris {
    #[serde(skip)]
    pub(crate) model: Arc<DebrisModel>,
    /// Where it is.
    pub pose: Pose,
    /// The places where robots may have seen it: the initial one if the piece was there, and one more each
    /// time that it was pushed noticeably or that an event moved it.
    pub sightings: Vec<Pose>,
    /// For each of these places, the step from which on it could be seen.
    pub since: Vec<u64>,
}

impl Deref for Debris {
    type Target = DebrisModel;

    fn deref(&self) -> &DebrisModel {
        &self.model
    }
}

impl Debris {
    /// A piece at its initial place; a piece that an event places later is away.
    pub(super) fn new(model: &Arc<DebrisModel>) -> Self {
        let mut pose = model.first_pose;
        let (mut sightings, mut since) = (vec![pose], vec![0]);
        if model.gate == Some(false) {
            sightings.clear();
            since.clear();
            pose.translation = AWAY;
        }
        Self { model: Arc::clone(model), pose, sightings, since }
    }

    /// The outline of the piece where it is.
    pub fn outline(&self) -> Outline {
        Outline { shape: self.model.shape.clone(), pose: self.pose }
    }

    /// Distance from a point to the piece, in metres; negative inside.
    pub(crate) fn signed_distance(&self, point: Vector) -> f32 {
        self.model.shape.distance_to_point(&self.pose, point, false)
    }

    /// Distance from a point to the piece, in metres; 0 inside.
    pub fn distance_to(&self, point: Vector) -> f32 {
        self.model.shape.distance_to_point(&self.pose, point, true)
    }

    /// Whether the piece is in the arena.
    pub fn is_there(&self) -> bool {
        self.pose.translation != AWAY
    }

    /// Puts the piece to a place, or away. Adds a sighting, so that passing robots notice the change.
    pub(super) fn put(&mut self, pose: Option<Pose>, step: u64) {
        match pose {
            Some(pose) => self.pose = pose,
            None => self.pose.translation = AWAY,
        }
        self.note_sighting(step);
    }

    /// The bounding box of the piece.
    pub fn bounds(&self) -> Aabb {
        self.model.shape.compute_aabb(&self.pose)
    }

    fn note_sighting(&mut self, step: u64) {
        self.sightings.push(self.pose);
        self.since.push(step);
    }

    /// How many of the sightings could be made up to a step, that step included.
    pub fn sightings_until(&self, step: u64) -> usize {
        self.since.partition_point(|since| *since <= step)
    }

    /// Takes a new pose from the physics.
    pub(super) fn moved_to(&mut self, pose: Pose, step: u64) {
        self.pose = pose;
        let seen = self.sightings[self.sightings.len() - 1];
        let arm = self.model.shape.compute_local_bounding_sphere().radius;
        let turned =
            Vector::new(pose.rotation.cos() - seen.rotation.cos(), pose.rotation.sin() - seen.rotation.sin());
        let moved = (seen.translation - pose.translation).length() + arm * turned.length();
        if moved > NOTICED_MOVE_M {
            self.note_sighting(step);
        }
    }
}
