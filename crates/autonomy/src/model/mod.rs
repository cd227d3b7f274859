//! The model of one trial: everything that is fixed once its seed is known, compiled into tables. It is built
//! once, shared by reference, and never in a snapshot. It holds no scenario: whoever decides or moves reads
//! its tables.

mod area;
mod costs;
mod debris;
mod layout;
mod mission;
mod names;
mod out_of_reach;
mod places;
mod rescuee;
mod right_of_way;
mod robot;
mod scatter;
mod task;
mod telemetry;
mod timeline;

use std::sync::Arc;

use parry2d::math::Vector;
use scenario::shapes::{RadiationZone, vector};
use scenario::{Measure, NeedFile, Scenario, ZoneFile};
use teaming::{Need, TaskId};

pub use area::TaskArea;
pub use costs::CostModel;
pub use debris::DebrisModel;
pub use layout::{Layout, RobotStart};
pub(crate) use mission::LATE_SHARE;
pub use mission::{ErrandModel, LowLevel, MissionModel};
pub use places::{RestSlots, rescuee_places};
pub use rescuee::RescueeModel;
pub use right_of_way::{Patience, ReciprocalModel, RetreatModel, RightOfWayModel, RuleKind, SetsModel};
pub use robot::{Brakes, RobotModel, RobotSpec};
pub use task::TaskModel;
pub use telemetry::{BlackoutModel, Liar, LieModel, MediumModel, TelemetryModel};
pub use timeline::{Action, Due};

use crate::hash::PERIOD_S;
use crate::planning::{Inflation, Planner};

/// Everything that is fixed in one trial.
#[derive(Debug)]
pub struct Model {
    /// Seed of the trial.
    pub seed: u64,
    dt_s: f64,
    /// Length of a step, in seconds, in the precision of the physics.
    pub dt: f32,
    /// Number of steps of the trial, unless its mission ends before.
    pub steps: u64,
    /// Steps between two links of the hash chain.
    pub link_steps: u64,
    /// Steps from one control step to the next. What robots count, they count in control steps.
    pub control_steps: u64,
    /// Width and height of the arena, in metres.
    pub arena: Vector,
    /// Whether robots speak of rescuees that do not exist: liars, or such as see them by mistake.
    pub has_phantoms: bool,
    /// Whether liars say that things are where they are not, so that robots look whether they are.
    pub has_misplaced: bool,
    /// Whether any robot sees rescuees where they are not, or overlooks them.
    pub has_sight_errors: bool,
    /// Names of the roles.
    pub roles: Vec<String>,
    /// The needs that robots report.
    pub needs: Vec<NeedModel>,
    /// Robots, by id.
    pub robots: Vec<Arc<RobotModel>>,
    /// Tasks, in the order of their table.
    pub tasks: Vec<TaskModel>,
    /// The tasks from the hardest to the easiest.
    pub hardest_first: Vec<TaskId>,
    /// Rescuees, by id.
    pub rescuees: Vec<RescueeModel>,
    /// Debris, by number.
    pub debris: Vec<Arc<DebrisModel>>,
    /// Numbers of the debris that events place or remove.
    pub gates: Vec<usize>,
    /// Radiation zones, by number.
    pub zones: Vec<ZoneModel>,
    /// The errands; if there are any, they take the place of the mission.
    pub errands: Vec<ErrandModel>,
    /// The actions of the timeline, in the order of their steps.
    pub timeline: Vec<Due>,
    /// What moving, radiation and work cost.
    pub costs: CostModel,
    /// The rules of the mission.
    pub mission: MissionModel,
    /// How robots report, are heard, and lie; `None` where everybody knows how every robot is.
    pub telemetry: Option<TelemetryModel>,
    /// The rules of right of way.
    pub right_of_way: RightOfWayModel,
    /// The planner of routes.
    pub planner: Planner,
    /// How much known obstacles are inflated.
    pub inflation: Inflation,
}

/// A need that robots report and policies compare.
#[derive(Debug, Clone)]
pub struct NeedModel {
    /// Its name and weight.
    pub asked: Need,
    /// What it measures.
    pub measures: Measure,
}

/// A radiation zone.
#[derive(Debug, Clone, Copy)]
pub struct ZoneModel {
    /// Its source and radius.
    pub disc: RadiationZone,
    /// Whether it is not there at the start.
    pub is_later: bool,
}

impl Model {
    /// Compiles the model of the trial of this seed. The scenario must have no distributions left (see
    /// [`Scenario::of_trial`]), and the layout must be its own (see [`Layout::sample`]).
    pub fn compile(scenario: &Scenario, layout: &Layout, seed: u64) -> Self {
        let dt_s = scenario.dt_s;
        let robots = RobotModel::compile_all(scenario, &layout.robots);
        let home = robots.iter().map(|robot| robot.home).sum::<Vector>() / robots.len() as f32;
        let rescuees = RescueeModel::compile_all(scenario);
        let need = |need: &NeedFile| NeedModel {
            asked: Need { name: need.name.clone(), weight: need.weight },
            measures: need.measures,
        };
        let zone = |(number, file): (usize, &ZoneFile)| ZoneModel {
            disc: file.zone(),
            is_later: layout.zones_later.contains(&number),
        };
        Self {
            seed,
            dt_s,
            dt: dt_s as f32,
            steps: scenario.steps(),
            link_steps: ((PERIOD_S / dt_s).round() as u64).max(1),
            control_steps: scenario.control_steps(),
            arena: vector(scenario.arena_m),
            has_phantoms: scenario.has_phantoms(),
            has_misplaced: scenario.has_misplaced(),
            has_sight_errors: scenario.has_sight_errors(),
            roles: scenario.roles.iter().map(|role| role.name.clone()).collect(),
            needs: scenario.needs.iter().map(need).collect(),
            tasks: TaskModel::compile_all(scenario, &rescuees, home),
            telemetry: TelemetryModel::compile(scenario, layout, &robots, seed),
            robots,
            hardest_first: scenario.hardest_first(),
            rescuees,
            debris: DebrisModel::compile_all(layout),
            gates: layout.gates.keys().copied().collect(),
            zones: layout.zones.iter().enumerate().map(zone).collect(),
            errands: scenario.errands.iter().map(ErrandModel::compile).collect(),
            timeline: timeline::timeline(scenario, layout),
            costs: CostModel::compile(&scenario.costs, dt_s),
            mission: MissionModel::compile(&scenario.mission, dt_s, scenario.control_steps() as f64 * dt_s),
            right_of_way: RightOfWayModel::compile(scenario),
            planner: Planner::new(scenario),
            inflation: Inflation::of(scenario),
        }
    }

    /// Length of a step, in seconds.
    pub fn dt_s(&self) -> f64 {
        self.dt_s
    }

    /// Time from one control step to the next, in seconds.
    pub fn control_period_s(&self) -> f64 {
        self.control_steps as f64 * self.dt_s
    }

    /// Number of steps in this many seconds.
    pub fn steps_in(&self, seconds: f64) -> u64 {
        (seconds / self.dt_s).round() as u64
    }

    /// Number of control steps in this many seconds.
    pub(crate) fn control_steps_in(&self, seconds: f64) -> u64 {
        (seconds / self.control_period_s()).round() as u64
    }

    /// Whether robots look around and choose their velocities in this step.
    pub fn is_control_step(&self, step: u64) -> bool {
        step.is_multiple_of(self.control_steps)
    }

    /// Whether something that is done once in `period` steps is due in a control step.
    pub(crate) fn is_due(&self, step: u64, period: u64) -> bool {
        step % period < self.control_steps
    }

    /// The ids of all tasks, in the order of their table.
    pub fn task_ids(&self) -> impl DoubleEndedIterator<Item = TaskId> + use<> {
        (0..self.tasks.len() as u16).map(TaskId)
    }
}
