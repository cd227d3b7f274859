//! What is wrong with robots by events of the timeline, and does not show in their gauges.

use serde::{Deserialize, Serialize};

use crate::conflict::Mover;
use crate::ids::RobotId;

/// The faults of all robots, by id; empty as long as there are none.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Faults(Vec<Fault>);

/// What is wrong with a robot.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Fault {
    /// The share of its speed that it has left.
    pub(super) speed: f64,
    /// The factor on the energy that it spends.
    pub(super) energy: f64,
}

impl Default for Fault {
    fn default() -> Self {
        Self { speed: 1.0, energy: 1.0 }
    }
}

impl Faults {
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The faults of a robot, to change them.
    pub(super) fn of(&mut self, robot: RobotId) -> &mut Fault {
        if self.0.len() <= robot.index() {
            self.0.resize_with(robot.index() + 1, Fault::default);
        }
        &mut self.0[robot.index()]
    }

    /// The speed of a robot that would have this speed.
    pub(super) fn speed_of(&self, robot: RobotId, speed: f64) -> f64 {
        self.0.get(robot.index()).map_or(speed, |fault| fault.speed * speed)
    }

    /// What a robot spends that would spend this energy.
    pub(super) fn energy_of(&self, robot: RobotId, energy: f64) -> f64 {
        self.0.get(robot.index()).map_or(energy, |fault| fault.energy * energy)
    }

    /// Slows the robots that are about to move.
    pub(super) fn slow(&self, movers: &mut [Mover<'_>]) {
        for (mover, fault) in movers.iter_mut().zip(&self.0) {
            mover.speed *= fault.speed as f32;
            mover.preferred *= fault.speed as f32;
        }
    }
}
