//! Robots: their motion, and the levels that decide what they can do.

use std::ops::Deref;
use std::sync::Arc;

use parry2d::math::Vector;
use rne_core::{NeedVector, NeedsError};
use serde::{Deserialize, Serialize};

use crate::ids::RescueeId;
use crate::model::{RobotModel, RobotStart};
use crate::scenario::{Measure, NeedFile};
use crate::vitals::health_factor;

/// Whether a robot can still act.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Condition {
    /// It can act.
    Able,
    /// Its energy is 0: it stays where it stopped, as an obstacle.
    Stranded,
    /// Its HP is 0: it stays where it stopped, as an obstacle.
    Disabled,
}

/// The state of a robot. A robot dereferences to its fixed properties, the [`RobotModel`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Robot {
    #[serde(skip)]
    pub(super) model: Arc<RobotModel>,
    /// Centre, in metres.
    pub position: Vector,
    /// Velocity, in metres per second.
    pub velocity: Vector,
    /// Battery level, in percent.
    pub energy: f64,
    /// Health level, in percent.
    pub hp: f64,
    /// Rescuing resources left in this round.
    pub resources: u32,
    /// Rescuees on board.
    pub load: Vec<RescueeId>,
    /// Whether it can still act.
    pub condition: Condition,
    /// The place where it came to rest for good, if it can no longer act.
    pub wreck_at: Option<Vector>,
}

impl Deref for Robot {
    type Target = RobotModel;

    fn deref(&self) -> &RobotModel {
        &self.model
    }
}

impl Robot {
    /// A robot at home, without motion, with its initial levels.
    pub(super) fn new(model: &Arc<RobotModel>, start: &RobotStart) -> Self {
        Self {
            model: Arc::clone(model),
            position: start.home,
            velocity: Vector::ZERO,
            energy: start.energy,
            hp: start.hp,
            resources: 0,
            load: Vec::new(),
            condition: Condition::Able,
            wreck_at: None,
        }
    }

    /// Whether it can still act.
    #[must_use]
    pub fn is_able(&self) -> bool {
        self.condition == Condition::Able
    }

    /// Number of rescuees for which it has room.
    #[must_use]
    pub fn free_capacity(&self) -> u32 {
        self.spec.capacity - self.load.len() as u32
    }

    /// Share of its capacity that is used, from 0 to 1.
    #[must_use]
    pub fn load_share(&self) -> f64 {
        self.load.len() as f64 / f64::from(self.spec.capacity.max(1))
    }

    /// Top speed at its present health, in metres per second.
    #[must_use]
    pub fn speed(&self) -> f64 {
        self.spec.speed_mps * self.health_factor()
    }

    /// Sensing range at its present health, in metres.
    #[must_use]
    pub fn sensing_range(&self) -> f64 {
        self.spec.sensing_m * self.health_factor()
    }

    /// Observing range at its present health, in metres.
    #[must_use]
    pub fn observing_range(&self) -> f64 {
        self.spec.observing_m * self.health_factor()
    }

    fn health_factor(&self) -> f64 {
        health_factor(self.hp, self.health_floor)
    }

    /// Its present needs, in the order of the table.
    ///
    /// # Errors
    /// None in a validated scenario: every value is finite and >= 0.
    pub fn needs(&self, table: &[NeedFile]) -> Result<NeedVector, NeedsError> {
        NeedVector::new(table.iter().map(|need| self.need(need)).collect())
    }

    fn need(&self, need: &NeedFile) -> f64 {
        match need.measures {
            Measure::Health => self.spec.hp * self.hp / 100.0,
            Measure::Speed => self.speed(),
            Measure::Sensing => self.sensing_range(),
            Measure::Energy => self.spec.energy * self.energy / 100.0,
            Measure::Resources => f64::from(self.resources),
            Measure::Capacity => f64::from(self.free_capacity()),
            Measure::Observing => self.observing_range(),
            Measure::Constant => self.spec.constants.get(&need.name).copied().unwrap_or(0.0),
        }
    }
}
