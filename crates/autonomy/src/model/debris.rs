//! The fixed properties of one piece of debris.

use std::sync::Arc;

use parry2d::math::{Pose, Vector};
use parry2d::shape::SharedShape;
use scenario::shapes::Outline;
use scenario::{DebrisFile, Movable};

use super::Layout;

/// The fixed properties of one piece of debris.
#[derive(Clone)]
pub struct DebrisModel {
    /// Its shape.
    pub shape: SharedShape,
    /// Its initial place, or the place where an event puts it.
    pub first_pose: Pose,
    /// Mass, and mass times the coefficient of friction with the ground, in kilograms; none for fixed debris.
    pub masses: Option<[f32; 2]>,
    /// Whether it is there at the start, if events place or remove it; none if no event does.
    pub gate: Option<bool>,
    /// Distance from its centre within which the whole piece lies, in metres.
    pub reach: f32,
}

impl Default for DebrisModel {
    fn default() -> Self {
        let Outline { shape, pose } = Outline::disc(Vector::ZERO, 0.0);
        Self { shape, first_pose: pose, masses: None, gate: None, reach: 0.0 }
    }
}

impl std::fmt::Debug for DebrisModel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("DebrisModel").field("first_pose", &self.first_pose).finish_non_exhaustive()
    }
}

impl DebrisModel {
    /// All debris of a layout, by number.
    pub(super) fn compile_all(layout: &Layout) -> Vec<Arc<Self>> {
        let gate = |number: usize| layout.gates.get(&number).copied();
        let pieces = layout.debris.iter().enumerate();
        pieces.map(|(number, file)| Arc::new(Self::compile(file, gate(number)))).collect()
    }

    fn compile(file: &DebrisFile, gate: Option<bool>) -> Self {
        let Outline { shape, pose } = file.outline();
        let bounds = shape.compute_local_bounding_sphere();
        let masses = |Movable { mass_kg, friction }| [mass_kg as f32, (friction * mass_kg) as f32];
        Self {
            masses: file.movable.map(masses),
            gate,
            reach: bounds.center.length() + bounds.radius,
            shape,
            first_pose: pose,
        }
    }

    /// Whether nothing can push it.
    pub fn is_fixed(&self) -> bool {
        self.masses.is_none()
    }

    /// Whether events place or remove it.
    pub fn is_gate(&self) -> bool {
        self.gate.is_some()
    }
}
