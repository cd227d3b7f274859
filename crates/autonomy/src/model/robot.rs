//! The fixed properties of one robot.

use std::sync::Arc;

use parry2d::math::Vector;
use scenario::{RoleFile, RoleKind, Scenario, Sight};
use teaming::{RoleId, TaskId};

use super::RobotStart;
use super::places::RestSlots;
use crate::ids::RobotId;

/// Share of the drive's acceleration that robots plan to brake with; the rest is in reserve.
pub(crate) const PLANNED_BRAKING: f32 = 0.8;

/// The fixed properties of one robot.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RobotModel {
    /// Identity.
    pub id: RobotId,
    /// Its role.
    pub role: RoleId,
    /// What it is and can do at full health.
    pub spec: Arc<RobotSpec>,
    /// Its place at home.
    pub home: Vector,
    /// Its place at the rest place of each task.
    pub rest: Vec<Vector>,
    /// Initial energy and HP, in percent.
    pub initial_levels: [f64; 2],
    /// Factor on speed and ranges at 0 % health.
    pub health_floor: f64,
}

/// What a robot is and can do at full health. Robots of a row share it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RobotSpec {
    /// Whether it flies.
    pub is_aerial: bool,
    /// Radius of its disc, in metres.
    pub radius: f32,
    /// Mass, in kilograms.
    pub mass: f32,
    /// Health points at 100 %.
    pub hp: f64,
    /// Battery capacity at 100 %.
    pub energy: f64,
    /// Top speed, in metres per second.
    pub speed_mps: f64,
    /// The same in the precision of the physics.
    pub top_speed: f32,
    /// Greatest acceleration and braking of the drive, in metres per second squared.
    pub acceleration: f32,
    /// How it plans to brake.
    pub brakes: Brakes,
    /// Greatest change of its velocity in one step, in metres per second.
    pub greatest_change: f32,
    /// Range within which debris and radiation are noticed, in metres.
    pub sensing_m: f64,
    /// Range within which rescuees are seen, in metres.
    pub observing_m: f64,
    /// What it sees wrong of rescuees.
    pub sight: Sight,
    /// Rescuees that it can have on board.
    pub capacity: u32,
    /// Rescuing resources that it takes along each round.
    pub resources: u32,
    /// Whether it guides its group.
    pub guides: bool,
    /// For each need, the constant of its role that has the need's name; 0 if there is none.
    pub constants: Vec<f64>,
}

/// How a robot plans to brake.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Brakes {
    /// Deceleration, in metres per second squared.
    pub deceleration: f32,
    /// Time that may pass before it looks again, beyond one step, in seconds.
    pub delay_s: f32,
}

impl Brakes {
    /// The way to a stop from a speed, in metres.
    pub fn way(self, speed: f32) -> f32 {
        speed * self.delay_s + speed * speed / (2.0 * self.deceleration)
    }

    /// The greatest speed at which a robot can still slow down to `target` metres per second within `way`
    /// metres.
    pub fn speed_before(self, target: f32, way: f32) -> f32 {
        let lost = self.deceleration * self.delay_s;
        (lost * lost + target * target + 2.0 * self.deceleration * way).sqrt() - lost
    }
}

impl RobotSpec {
    fn compile(body: &RoleFile, scenario: &Scenario, delay_s: f64) -> Self {
        let acceleration = body.acceleration_mps2 as f32;
        let constant = |name: &String| body.constants.get(name).copied().unwrap_or(0.0);
        Self {
            is_aerial: body.kind == RoleKind::Aerial,
            radius: body.radius_m as f32,
            mass: body.mass_kg as f32,
            hp: body.hp,
            energy: body.energy,
            speed_mps: body.speed_mps,
            top_speed: body.speed_mps as f32,
            acceleration,
            brakes: Brakes { deceleration: PLANNED_BRAKING * acceleration, delay_s: delay_s as f32 },
            greatest_change: (body.acceleration_mps2 * scenario.dt_s) as f32,
            sensing_m: body.sensing_m,
            observing_m: body.observing_m,
            sight: body.sight,
            capacity: body.capacity,
            resources: body.resources,
            guides: body.guides,
            constants: scenario.needs.iter().map(|need| constant(&need.name)).collect(),
        }
    }
}

impl RobotModel {
    /// All robots of a scenario, by id.
    pub(super) fn compile_all(scenario: &Scenario, starts: &[RobotStart]) -> Vec<Arc<Self>> {
        let delay_s = (scenario.control_steps() - 1) as f64 * scenario.dt_s;
        let spec = |body: RoleFile| Arc::new(RobotSpec::compile(&body, scenario, delay_s));
        let specs = scenario.bodies().map(|(body, count)| (spec(body), count));
        let specs = specs.flat_map(|(spec, count)| (0..count).map(move |_| Arc::clone(&spec)));
        let slots = RestSlots::of(scenario);
        let tasks = scenario.tasks.len() as u16;
        let robot = |(start, spec): (&RobotStart, Arc<RobotSpec>)| Self {
            id: start.id,
            role: start.role,
            spec,
            home: start.home,
            rest: (0..tasks).map(|task| slots.at(TaskId(task), start.id)).collect(),
            initial_levels: [start.energy, start.hp],
            health_floor: scenario.mission.health_floor,
        };
        starts.iter().zip(specs).map(robot).map(Arc::new).collect()
    }

    /// Whether it flies.
    pub fn is_aerial(&self) -> bool {
        self.spec.is_aerial
    }

    /// Whether it can take rescuees on board at all.
    pub fn can_carry(&self) -> bool {
        self.spec.capacity > 0
    }

    /// Radius, in metres.
    pub fn radius(&self) -> f32 {
        self.spec.radius
    }

    /// Its place at the rest place of a task.
    pub fn rest_slot(&self, task: TaskId) -> Vector {
        self.rest[task.index()]
    }
}
