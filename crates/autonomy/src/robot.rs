//! The state of a robot: its motion, and the levels that decide what it can do. A robot of the world has one,
//! a belief the one that the robot reported.

use std::ops::Deref;
use std::sync::Arc;

use parry2d::math::Vector;
use rne_core::{NeedVector, NeedsError};
use scenario::Measure;
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;
use teaming::{LevelId, LevelNeed, Member, NeedId};

use crate::ids::RescueeId;
use crate::model::{NeedModel, RobotModel};
use crate::vitals::health_factor;

/// A robot slower than this stands, in metres per second.
pub const STANDING_MPS: f32 = 0.05;

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
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct RobotState {
    #[serde(skip)]
    /// Its fixed properties, which no snapshot has.
    pub model: Arc<RobotModel>,
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
    pub load: SmallVec<[RescueeId; 8]>,
    /// Whether it can still act.
    pub condition: Condition,
    /// The place where it came to rest for good, if it can no longer act.
    pub wreck_at: Option<Vector>,
}

impl Clone for RobotState {
    fn clone(&self) -> Self {
        Self { model: Arc::clone(&self.model), load: SmallVec::from_slice(&self.load), ..*self }
    }
}

impl Deref for RobotState {
    type Target = RobotModel;

    fn deref(&self) -> &RobotModel {
        &self.model
    }
}

impl RobotState {
    /// A robot at home, without motion, with its initial levels.
    pub fn new(model: &Arc<RobotModel>) -> Self {
        let [energy, hp] = model.initial_levels;
        Self {
            model: Arc::clone(model),
            position: model.home,
            velocity: Vector::ZERO,
            energy,
            hp,
            resources: 0,
            load: SmallVec::new(),
            condition: Condition::Able,
            wreck_at: None,
        }
    }

    /// Takes over the state of another. Its fixed properties stay.
    pub(crate) fn be_as(&mut self, other: &Self) {
        let Self { model: _, position, velocity, energy, hp, resources, load, condition, wreck_at } = other;
        (self.position, self.velocity) = (*position, *velocity);
        (self.energy, self.hp, self.resources) = (*energy, *hp, *resources);
        (self.condition, self.wreck_at) = (*condition, *wreck_at);
        if self.load != *load {
            self.load.clone_from(load);
        }
    }

    /// Whether it is in the same state as another. Their fixed properties are not compared.
    #[expect(clippy::float_cmp, reason = "a report is as the robot is, bit for bit, or it is not")]
    pub fn is_as(&self, other: &Self) -> bool {
        let Self { model: _, position, velocity, energy, hp, resources, load, condition, wreck_at } = self;
        *position == other.position
            && *velocity == other.velocity
            && [*energy, *hp] == [other.energy, other.hp]
            && *resources == other.resources
            && *load == other.load
            && *condition == other.condition
            && *wreck_at == other.wreck_at
    }

    /// The same robot with these levels of energy and health, in percent.
    pub(crate) fn with_levels(&self, [energy, hp]: [f64; 2]) -> Self {
        Self { energy, hp, ..self.clone() }
    }

    /// Its needs when it is fresh, in the order of the table: full, stocked and without a load.
    pub(crate) fn fresh_needs(&self, table: &[NeedModel]) -> Vec<f64> {
        let resources = self.spec.resources;
        let fresh = Self { resources, load: SmallVec::new(), ..self.with_levels([100.0; 2]) };
        let needs = table.iter().zip(&self.spec.constants);
        needs.map(|(need, constant)| fresh.need(need.measures, *constant)).collect()
    }

    /// Whether it can still act.
    pub fn is_able(&self) -> bool {
        self.condition == Condition::Able
    }

    /// Number of rescuees for which it has room.
    pub fn free_capacity(&self) -> u32 {
        self.spec.capacity - self.load.len() as u32
    }

    /// Share of its capacity that is used, from 0 to 1.
    pub(crate) fn load_share(&self) -> f64 {
        self.load.len() as f64 / f64::from(self.spec.capacity.max(1))
    }

    /// Top speed at its present health, in metres per second.
    pub fn speed(&self) -> f64 {
        self.spec.speed_mps * self.health_factor()
    }

    /// Sensing range at its present health, in metres.
    pub fn sensing_range(&self) -> f64 {
        self.spec.sensing_m * self.health_factor()
    }

    /// Observing range at its present health, in metres.
    pub fn observing_range(&self) -> f64 {
        self.spec.observing_m * self.health_factor()
    }

    /// Top speed at this health level, in percent, in metres per second.
    pub(crate) fn speed_at(&self, hp: f64) -> f64 {
        self.spec.speed_mps * health_factor(hp, self.health_floor)
    }

    fn health_factor(&self) -> f64 {
        health_factor(self.hp, self.health_floor)
    }

    /// Its present needs, in the order of the table.
    ///
    /// # Errors
    /// None in a validated scenario: every value is finite and >= 0.
    pub fn needs(&self, table: &[NeedModel]) -> Result<NeedVector, NeedsError> {
        let needs = table.iter().zip(&self.spec.constants);
        NeedVector::new(needs.map(|(need, constant)| self.need(need.measures, *constant)).collect())
    }

    /// The robot as a member of a team that is to be grouped; none if its needs are no numbers, which is
    /// never so in a validated scenario.
    pub fn member(&self, table: &[NeedModel]) -> Option<Member> {
        Some(Member {
            id: self.id.0,
            role: self.role,
            home: [f64::from(self.home.x), f64::from(self.home.y)],
            needs: self.needs(table).ok()?,
            levels: vec![Some(self.energy), Some(self.hp)],
        })
    }

    /// Its needs that follow from a level. All of them do so in a straight line.
    pub(crate) fn level_needs(&self, table: &[NeedModel]) -> Vec<LevelNeed> {
        let [empty, full] = [0.0, 100.0].map(|level| self.with_levels([level; 2]));
        let of = |(place, need): (u16, &NeedModel)| {
            let value = |robot: &Self| robot.need(need.measures, 0.0);
            let level = level_of(need.measures)?;
            Some(LevelNeed { need: NeedId(place), level, at_0: value(&empty), at_100: value(&full) })
        };
        (0..).zip(table).filter_map(of).collect()
    }

    fn need(&self, measures: Measure, constant: f64) -> f64 {
        match measures {
            Measure::Health => self.spec.hp * self.hp / 100.0,
            Measure::Speed => self.speed(),
            Measure::Sensing => self.sensing_range(),
            Measure::Energy => self.spec.energy * self.energy.max(0.0) / 100.0,
            Measure::Resources => f64::from(self.resources),
            Measure::Capacity => f64::from(self.free_capacity()),
            Measure::Observing => self.observing_range(),
            Measure::Constant => constant,
        }
    }
}

/// The place of the battery level in the table of levels.
pub const ENERGY: LevelId = LevelId(0);

/// The place of the health level.
pub const HP: LevelId = LevelId(1);

/// The level that a need follows from, if it follows from one.
fn level_of(measures: Measure) -> Option<LevelId> {
    match measures {
        Measure::Health | Measure::Speed | Measure::Sensing | Measure::Observing => Some(HP),
        Measure::Energy => Some(ENERGY),
        Measure::Resources | Measure::Capacity | Measure::Constant => None,
    }
}
