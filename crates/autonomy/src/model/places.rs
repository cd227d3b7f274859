//! Places of rescuees and of resting robots, which follow from the scenario alone.

use std::ops::Range;

use parry2d::math::Vector;
use scenario::shapes::vector;
use scenario::{Happening, Point, RoleKind, Scenario, TaskFile};
use teaming::TaskId;

use crate::ids::RobotId;

/// Free distance between two robots at a rest place, in metres, so that others can pass between them.
const REST_GAP_M: f64 = 1.2;

/// The robots' own slots at the rest places of the tasks. The slots of a rest place form a nearly square
/// block round its centre, in order of ids.
#[derive(Debug, Clone)]
pub struct RestSlots {
    /// Centre of each task's rest place.
    centers: Vec<Point>,
    columns: u32,
    rows: u32,
    /// Distance between two slots, in metres.
    spacing: f64,
}

impl RestSlots {
    /// The slots of a scenario's team, in O(rows of the team).
    pub fn of(scenario: &Scenario) -> Self {
        let robots = scenario.robots();
        let columns = robots.isqrt() + u32::from(robots.isqrt().pow(2) < robots);
        let largest =
            scenario.largest_radius_m(RoleKind::Ground).max(scenario.largest_radius_m(RoleKind::Aerial));
        Self {
            centers: scenario.tasks.iter().map(|task| task.rest).collect(),
            columns,
            rows: robots.div_ceil(columns.max(1)),
            spacing: 2.0 * largest + REST_GAP_M,
        }
    }

    /// A robot's slot at a task's rest place, in O(1).
    ///
    /// # Panics
    /// The scenario has no such task, or no robot at all.
    pub fn at(&self, task: TaskId, robot: RobotId) -> Vector {
        let offset = |i: u32, count: u32| self.spacing * (f64::from(i) - f64::from(count - 1) / 2.0);
        let center = self.centers[task.index()];
        let x = center[0] + offset(robot.0 % self.columns, self.columns);
        let y = center[1] + offset(robot.0 / self.columns, self.rows);
        vector([x, y])
    }
}

/// The task and the place of each rescuee, by id. Rescuees are ordered by task. Those of the task's own
/// regular grid come first, and those that appear later follow.
pub fn rescuee_places(scenario: &Scenario) -> impl Iterator<Item = (TaskId, Vector)> + '_ {
    (0..).zip(&scenario.tasks).flat_map(move |(number, task)| {
        let later = later_grids(scenario, task).flat_map(move |(_, cells)| cells_of(task, cells));
        grid(task).chain(later).map(move |at| (TaskId(number), at))
    })
}

/// Rescuees that appear at the same moment.
pub(super) struct Block {
    /// Number of the event with which they appear; none for rescuees of the task's own grid.
    pub(super) moment: Option<usize>,
    /// Their ids.
    pub(super) ids: Range<usize>,
}

/// The blocks of rescuees, in the order of their ids.
pub(super) fn rescuee_blocks(scenario: &Scenario) -> Vec<Block> {
    let (mut blocks, mut next) = (Vec::new(), 0);
    for task in &scenario.tasks {
        let own = std::iter::once((None, task.grid));
        let later = later_grids(scenario, task).map(|(moment, cells)| (Some(moment), cells));
        for (moment, cells) in own.chain(later) {
            let count = cells[0] as usize * cells[1] as usize;
            blocks.push(Block { moment, ids: next..next + count });
            next += count;
        }
    }
    blocks
}

/// The grids of rescuees that events add to a task, each with the number of its event.
fn later_grids<'s>(scenario: &'s Scenario, of: &'s TaskFile) -> impl Iterator<Item = (usize, [u32; 2])> + 's {
    scenario.timeline.iter().enumerate().filter_map(|(number, moment)| match &moment.event {
        Happening::RescueesAppear { task, grid } if *task == of.name => Some((number, *grid)),
        _ => None,
    })
}

fn grid(task: &TaskFile) -> impl Iterator<Item = Vector> + '_ {
    let along = |i: u32, count: u32, center: f64, size: f64| {
        if count < 2 { center } else { center - size / 2.0 + size * f64::from(i) / f64::from(count - 1) }
    };
    let place = move |column: u32, row: u32| {
        let x = along(column, task.grid[0], task.center[0], task.size_m[0]);
        let y = along(row, task.grid[1], task.center[1], task.size_m[1]);
        vector([x, y])
    };
    (0..task.grid[1]).flat_map(move |row| (0..task.grid[0]).map(move |column| place(column, row)))
}

/// Middles of the cells of a grid over a task's block.
fn cells_of(task: &TaskFile, [columns, rows]: [u32; 2]) -> impl Iterator<Item = Vector> + '_ {
    let along = |k: usize, i: u32, count: u32| {
        task.center[k] + task.size_m[k] * ((f64::from(i) + 0.5) / f64::from(count) - 0.5)
    };
    let place = move |column, row| vector([along(0, column, columns), along(1, row, rows)]);
    (0..rows).flat_map(move |row| (0..columns).map(move |column| place(column, row)))
}
