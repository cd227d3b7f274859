//! Robots: what they are, where they are, and the levels that decide what they can do.

use parry2d::math::Vector;
use rne_core::{Difficulty, NeedVector, NeedsError, Role};
use serde::{Deserialize, Serialize};

use crate::ids::{RescueeId, RobotId};
use crate::layout::RobotStart;
use crate::scenario::{RoleSpec, Row, Scenario};
use crate::vitals::health_factor;

/// Whether a robot can still act.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Condition {
    /// It can.
    Able,
    /// Its energy is 0: it stands where it stopped, an obstacle.
    Stranded,
    /// Its HP is 0: likewise.
    Disabled,
}

/// A robot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Robot {
    /// Identity.
    pub id: RobotId,
    /// What it is for.
    pub role: Role,
    /// What it is and can do at full health.
    pub spec: RoleSpec,
    /// Its place at home.
    pub home: Vector,
    /// Its place at the rest place of the hard and of the easy task.
    pub rest: [Vector; 2],
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
    /// Where it came to stand for good, once it can no longer act.
    pub wreck_at: Option<Vector>,
    health_floor: f64,
}

impl Robot {
    /// At home, at rest, with its initial levels.
    pub(super) fn new(scenario: &Scenario, start: &RobotStart) -> Self {
        let spec = *scenario.roles.of(start.role);
        let robots = scenario.team.iter().map(|row| row.count).sum();
        let rest = Difficulty::ALL.map(|task| rest_slot(scenario, task, start.id, robots));
        Self {
            id: start.id,
            role: start.role,
            spec,
            home: start.home,
            rest,
            position: start.home,
            velocity: Vector::ZERO,
            energy: start.energy,
            hp: start.hp,
            resources: 0,
            load: Vec::new(),
            condition: Condition::Able,
            wreck_at: None,
            health_floor: scenario.mission.health_floor,
        }
    }

    /// Whether it can still act.
    #[must_use]
    pub fn is_able(&self) -> bool {
        self.condition == Condition::Able
    }

    /// Whether it flies.
    #[must_use]
    pub fn is_aerial(&self) -> bool {
        self.role == Role::Observer
    }

    /// Whether it can have rescuees on board at all.
    #[must_use]
    pub fn can_carry(&self) -> bool {
        self.spec.capacity > 0
    }

    /// Rescuees that it has room for.
    #[must_use]
    pub fn free_capacity(&self) -> u32 {
        self.spec.capacity - self.load.len() as u32
    }

    /// Radius, in metres.
    #[must_use]
    pub fn radius(&self) -> f32 {
        self.spec.radius_m as f32
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

    /// Its place at the rest place of a task.
    #[must_use]
    pub fn rest_slot(&self, task: Difficulty) -> Vector {
        self.rest[usize::from(task == Difficulty::Easy)]
    }

    /// Its seven needs, in the order of [`rne_core::NEED_NAMES`], as they are now.
    ///
    /// # Errors
    /// None in a validated scenario: every value is finite and >= 0.
    pub fn needs(&self) -> Result<NeedVector, NeedsError> {
        NeedVector::new(vec![
            self.spec.hp * self.hp / 100.0,
            self.speed(),
            self.sensing_range(),
            self.spec.energy * self.energy / 100.0,
            f64::from(self.resources),
            f64::from(self.free_capacity()),
            self.observing_range(),
        ])
    }
}

/// Places of the robots of a row, side by side.
pub fn row_positions(row: &Row) -> impl Iterator<Item = [f64; 2]> {
    let gaps = f64::from(row.count.saturating_sub(1).max(1));
    let left = if row.count > 1 { row.center[0] - row.width_m / 2.0 } else { row.center[0] };
    (0..row.count).map(move |i| [left + row.width_m * f64::from(i) / gaps, row.center[1]])
}

/// Free distance between two robots at a rest place, in metres: others can pass between them.
const REST_GAP_M: f64 = 1.2;

/// A robot's own place at a task's rest place: a square block around its centre, in order of ids.
#[must_use]
pub fn rest_slot(scenario: &Scenario, task: Difficulty, robot: RobotId, robots: u32) -> Vector {
    let columns = robots.isqrt() + u32::from(robots.isqrt().pow(2) < robots);
    let rows = robots.div_ceil(columns);
    let spacing = 2.0 * scenario.ground_radius_m().max(scenario.aerial_radius_m()) + REST_GAP_M;
    let offset = |i: u32, count: u32| spacing * (f64::from(i) - f64::from(count - 1) / 2.0);
    let center = scenario.tasks.of(task).rest;
    let x = center[0] + offset(robot.0 % columns, columns);
    let y = center[1] + offset(robot.0 / columns, rows);
    Vector::new(x as f32, y as f32)
}
