//! Places that follow from the scenario alone: of rescuees, and of robots at rest.

use parry2d::math::Vector;
use rne_core::TaskId;

use crate::ids::RobotId;
use crate::scenario::{RoleKind, Scenario, TaskFile};

/// Free distance between two robots at a rest place, in metres: others can pass between them.
const REST_GAP_M: f64 = 1.2;

/// A robot's own place at a task's rest place: a square block around its centre, in order of ids.
#[must_use]
pub fn rest_slot(scenario: &Scenario, task: TaskId, robot: RobotId) -> Vector {
    let robots = scenario.robots();
    let columns = robots.isqrt() + u32::from(robots.isqrt().pow(2) < robots);
    let rows = robots.div_ceil(columns);
    let largest =
        scenario.largest_radius_m(RoleKind::Ground).max(scenario.largest_radius_m(RoleKind::Aerial));
    let spacing = 2.0 * largest + REST_GAP_M;
    let offset = |i: u32, count: u32| spacing * (f64::from(i) - f64::from(count - 1) / 2.0);
    let center = scenario.tasks[task.index()].rest;
    let x = center[0] + offset(robot.0 % columns, columns);
    let y = center[1] + offset(robot.0 / columns, rows);
    Vector::new(x as f32, y as f32)
}

/// The task and the place of each rescuee, by id: task by task, each in a regular grid.
pub fn rescuee_places(scenario: &Scenario) -> impl Iterator<Item = (TaskId, Vector)> + '_ {
    (0..).zip(&scenario.tasks).flat_map(|(number, task)| grid(task).map(move |at| (TaskId(number), at)))
}

fn grid(task: &TaskFile) -> impl Iterator<Item = Vector> + '_ {
    let along = |i: u32, count: u32, center: f64, size: f64| {
        if count < 2 { center } else { center - size / 2.0 + size * f64::from(i) / f64::from(count - 1) }
    };
    let place = move |column: u32, row: u32| {
        let x = along(column, task.grid[0], task.center[0], task.size_m[0]);
        let y = along(row, task.grid[1], task.center[1], task.size_m[1]);
        Vector::new(x as f32, y as f32)
    };
    (0..task.grid[1]).flat_map(move |row| (0..task.grid[0]).map(move |column| place(column, row)))
}
