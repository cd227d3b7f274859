//! The fixed properties of one task.

use std::ops::Range;

use parry2d::math::Vector;
use scenario::{Scenario, TaskFile};
use teaming::{Task, TaskId};

use super::TaskArea;
use super::rescuee::RescueeModel;

/// The fixed properties of one task.
#[derive(Debug)]
pub struct TaskModel {
    /// The task as questions have it, without the number of its rescuees.
    pub asked: Task,
    /// For each role, how many robots of it the task asks for; none if it asks for no number.
    pub quota: Vec<Option<usize>>,
    /// Its area.
    pub area: TaskArea,
    /// Its rank among all tasks: 0 is the hardest.
    pub rank: u8,
    /// Ids of its rescuees.
    pub rescuees: Range<usize>,
    /// Lower left and upper right corner of the places of its rescuees; infinite and inverted if it has none.
    pub bounds: [Vector; 2],
    /// Whether it begins with an event of the timeline.
    pub begins_later: bool,
    /// Ids of the rescuees that appear when it begins for the first time; none if it has no such rescuees.
    pub appear_at_begin: Option<Range<usize>>,
}

impl TaskModel {
    /// All tasks of a scenario, in the order of their table. `home` is the middle of the robots' homes.
    pub(super) fn compile_all(scenario: &Scenario, rescuees: &[RescueeModel], home: Vector) -> Vec<Self> {
        let hardest_first = scenario.hardest_first();
        let robots = scenario.robots() as usize;
        let task = |(file, id): (&TaskFile, TaskId)| {
            let ids = ids_of(id, rescuees);
            let begins_later = scenario.begins_later(file);
            let own = file.grid[0] as usize * file.grid[1] as usize;
            Self {
                asked: asked(scenario, file),
                quota: scenario.roles.iter().map(|role| quota(file, &role.name)).collect(),
                area: TaskArea::new(scenario, file, home, robots),
                rank: hardest_first.iter().position(|other| *other == id).unwrap_or_default() as u8,
                bounds: bounds(&rescuees[ids.clone()]),
                appear_at_begin: (begins_later && own > 0).then(|| ids.start..ids.start + own),
                begins_later,
                rescuees: ids,
            }
        };
        scenario.tasks.iter().zip((0..).map(TaskId)).map(task).collect()
    }
}

/// What questions say of a task.
fn asked(scenario: &Scenario, file: &TaskFile) -> Task {
    let number = |name: &String| scenario.tasks.iter().position(|task| task.name == *name);
    Task {
        name: file.name.clone(),
        difficulty: file.difficulty,
        place: Some(file.center),
        rescuees: None,
        value: file.value,
        requires: file.requires.clone(),
        duration_s: file.duration_s,
        after: file.after.iter().filter_map(number).map(|number| TaskId(number as u16)).collect(),
    }
}

fn quota(file: &TaskFile, role: &str) -> Option<usize> {
    file.quota.get(role).map(|quota| *quota as usize)
}

fn ids_of(task: TaskId, rescuees: &[RescueeModel]) -> Range<usize> {
    let first = rescuees.partition_point(|other| other.task < task);
    first..rescuees.partition_point(|other| other.task <= task)
}

fn bounds(rescuees: &[RescueeModel]) -> [Vector; 2] {
    let nothing = [Vector::INFINITY, Vector::NEG_INFINITY];
    rescuees
        .iter()
        .fold(nothing, |[min, max], rescuee| [min.min(rescuee.position), max.max(rescuee.position)])
}
