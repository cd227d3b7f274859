//! The model of one trial: everything that is fixed once its seed is known. It is built once, shared by
//! reference, and never in a snapshot.

mod area;
mod layout;
mod places;
mod scatter;
mod timeline;

use std::ops::Range;
use std::sync::Arc;

use parry2d::math::Vector;
use rne_core::{RoleId, TaskId};

pub use area::TaskArea;
pub use layout::{Layout, RobotStart};
pub use places::{rescuee_places, rest_slot};
pub use timeline::{Action, Due};

use crate::ids::RobotId;
use crate::scenario::{LayoutError, RoleFile, RoleKind, Scenario};

/// Robots look around, and look for work, once in this many steps (0.1 s at the usual step).
pub const SENSING_PERIOD_STEPS: u64 = 5;

/// Everything that is fixed in one trial.
#[derive(Debug)]
pub struct Model {
    /// The scenario, with the values drawn from its distributions for this trial.
    pub scenario: Scenario,
    /// The scenario with its distributions, if it has any.
    given: Option<Scenario>,
    /// Seed of the trial.
    pub seed: u64,
    /// What was drawn from the seed.
    pub layout: Layout,
    /// Robots, by id.
    pub robots: Vec<Arc<RobotModel>>,
    /// Tasks, in the order of their table.
    pub tasks: Vec<TaskModel>,
    /// The tasks from the hardest to the easiest.
    pub hardest_first: Vec<TaskId>,
    /// Task and place of each rescuee, by id.
    pub rescuees: Vec<(TaskId, Vector)>,
    /// Ids of the rescuees that are not there at the start.
    pub rescuees_later: Vec<Range<usize>>,
    /// The actions of the timeline, in the order of their steps.
    pub timeline: Vec<Due>,
}

/// The fixed properties of one robot.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RobotModel {
    /// Identity.
    pub id: RobotId,
    /// Its role.
    pub role: RoleId,
    /// Properties and abilities of its role at full health, with the changes of its row.
    pub spec: Arc<RoleFile>,
    /// Its place at home.
    pub home: Vector,
    /// Its place at the rest place of each task.
    pub rest: Vec<Vector>,
    /// Factor on speed and ranges at 0 % health.
    pub health_floor: f64,
}

impl RobotModel {
    /// Whether it flies.
    #[must_use]
    pub fn is_aerial(&self) -> bool {
        self.spec.kind == RoleKind::Aerial
    }

    /// Whether it can take rescuees on board at all.
    #[must_use]
    pub fn can_carry(&self) -> bool {
        self.spec.capacity > 0
    }

    /// Radius, in metres.
    #[must_use]
    pub fn radius(&self) -> f32 {
        self.spec.radius_m as f32
    }

    /// Its place at the rest place of a task.
    #[must_use]
    pub fn rest_slot(&self, task: TaskId) -> Vector {
        self.rest[task.index()]
    }
}

/// The fixed properties of one task.
#[derive(Debug)]
pub struct TaskModel {
    /// Its area.
    pub area: TaskArea,
    /// Its rank among all tasks: 0 is the hardest.
    pub rank: u8,
    /// Ids of its rescuees.
    pub rescuees: Range<usize>,
    /// Lower left and upper right corner of the places of its rescuees; infinite and inverted if it has none.
    pub bounds: [Vector; 2],
}

impl Model {
    /// Draws what the seed decides, and derives the rest of the model from it.
    ///
    /// # Errors
    /// The layout cannot be drawn.
    pub fn compile(scenario: &Scenario, seed: u64) -> Result<Arc<Self>, LayoutError> {
        let given = (!scenario.draws.is_empty()).then(|| scenario.clone());
        let scenario = &scenario.of_trial(seed)?;
        let layout = Layout::sample(scenario, seed)?;
        let specs = bodies(scenario);
        let tasks = || (0..scenario.tasks.len() as u16).map(TaskId);
        let robot = |start: &RobotStart| {
            Arc::new(RobotModel {
                id: start.id,
                role: start.role,
                spec: Arc::clone(&specs[start.id.index()]),
                home: start.home,
                rest: tasks().map(|task| rest_slot(scenario, task, start.id)).collect(),
                health_floor: scenario.mission.health_floor,
            })
        };
        let robots: Vec<Arc<RobotModel>> = layout.robots.iter().map(robot).collect();
        let home = robots.iter().map(|robot| robot.home).sum::<Vector>() / robots.len() as f32;
        let rescuees: Vec<(TaskId, Vector)> = rescuee_places(scenario).collect();
        let hardest_first = scenario.hardest_first();
        let task = |task: TaskId| TaskModel {
            area: TaskArea::new(scenario, &scenario.tasks[task.index()], home, robots.len()),
            rank: hardest_first.iter().position(|other| *other == task).unwrap_or_default() as u8,
            rescuees: ids_of(task, &rescuees),
            bounds: bounds(&rescuees[ids_of(task, &rescuees)]),
        };
        let tasks = tasks().map(task).collect();
        let timeline = timeline::timeline(scenario, &layout);
        Ok(Arc::new(Self {
            scenario: scenario.clone(),
            given,
            rescuees_later: later(scenario),
            timeline,
            seed,
            layout,
            robots,
            tasks,
            hardest_first,
            rescuees,
        }))
    }

    /// The scenario as it was given, with its distributions.
    #[must_use]
    pub fn given(&self) -> &Scenario {
        self.given.as_ref().unwrap_or(&self.scenario)
    }

    /// Length of a step, in seconds.
    #[must_use]
    pub fn dt_s(&self) -> f64 {
        self.scenario.dt_s
    }

    /// Number of steps in this many seconds.
    #[must_use]
    pub fn steps(&self, seconds: f64) -> u64 {
        (seconds / self.scenario.dt_s).round() as u64
    }

    /// The ids of all tasks, in the order of their table.
    pub fn task_ids(&self) -> impl DoubleEndedIterator<Item = TaskId> + use<> {
        (0..self.tasks.len() as u16).map(TaskId)
    }
}

/// Properties and abilities of each robot, by id; robots of a row share them.
fn bodies(scenario: &Scenario) -> Vec<Arc<RoleFile>> {
    let rows =
        scenario.team.iter().map(|row| (Arc::new(scenario.body_of(row).unwrap_or_default()), row.count));
    rows.flat_map(|(body, count)| (0..count).map(move |_| Arc::clone(&body))).collect()
}

/// Ids of the rescuees that appear with an event, and of rescuees whose task begins with one.
fn later(scenario: &Scenario) -> Vec<Range<usize>> {
    if scenario.timeline.is_empty() {
        return Vec::new();
    }
    let mut task = scenario.tasks.iter();
    let mut begins_later = false;
    let is_later = |block: &places::Block| {
        if block.moment.is_none() {
            begins_later = task.next().is_some_and(|task| scenario.begins_later(task));
        }
        block.moment.is_some() || begins_later
    };
    let mut is_later = is_later;
    places::rescuee_blocks(scenario)
        .into_iter()
        .filter(|block| is_later(block))
        .map(|block| block.ids)
        .collect()
}

fn ids_of(task: TaskId, rescuees: &[(TaskId, Vector)]) -> Range<usize> {
    let first = rescuees.partition_point(|(other, _)| *other < task);
    first..rescuees.partition_point(|(other, _)| *other <= task)
}

fn bounds(rescuees: &[(TaskId, Vector)]) -> [Vector; 2] {
    let nothing = [Vector::INFINITY, Vector::NEG_INFINITY];
    rescuees.iter().fold(nothing, |[min, max], (_, at)| [min.min(*at), max.max(*at)])
}
