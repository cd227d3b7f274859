//! Whether the parts of a scenario fit together: a robot can do the work, and robots can reach what they
//! need.

use parry2d::query::distance;

use super::checker::{Checker, entry};
use super::file::{DebrisFile, DebrisShape, Point, RoleFile, RoleKind, ScenarioFile, TaskFile};
use crate::limits;
use crate::shapes::Outline;

/// Checks these rules. Places and shapes must be sound.
pub(super) fn feasibility(check: &mut Checker, file: &ScenarioFile) {
    stacked(check, file);
    if !file.errands.is_empty() {
        return;
    }
    team(check, file);
    for (i, task) in file.tasks.iter().enumerate() {
        if let Some(other) = file.tasks[..i].iter().find(|other| overlap(task, other)) {
            let rule = "must not be on top of another task";
            check.fail(
                format!("{}.center", entry("tasks", &task.name)),
                rule,
                format!("task {}", other.name),
            );
        }
    }
    let drives = |row| file.body_of(row).is_some_and(|body| body.kind == RoleKind::Ground);
    if file.team.iter().any(drives) {
        places(check, file);
    }
}

/// Checks that a robot can carry and that a robot has resources, if there are rescuees.
fn team(check: &mut Checker, file: &ScenarioFile) {
    if file.tasks.iter().all(|task| task.grid.contains(&0)) {
        return; // nobody to rescue
    }
    let has = |what: fn(&RoleFile) -> u32| {
        let rows = file.team.iter().filter(|row| row.count > 0).filter_map(|row| file.body_of(row));
        rows.map(|body| what(&body)).any(|count| count > 0)
    };
    if !has(|body| body.capacity) {
        check.fail("team", "must have a robot that can carry: a role with a capacity above 0", "none");
    }
    if !has(|body| body.resources) {
        check.fail("team", "must have a robot with resources: a role with resources above 0", "none");
    }
}

/// Whether two blocks of rescuees overlap.
fn overlap(a: &TaskFile, b: &TaskFile) -> bool {
    (0..2).all(|k| (a.center[k] - b.center[k]).abs() < f64::midpoint(a.size_m[k], b.size_m[k]))
}

/// Checks that no two movable pieces are on the same point. The engine would throw them apart.
fn stacked(check: &mut Checker, file: &ScenarioFile) {
    let mut movable: Vec<(usize, Point)> = Vec::new();
    movable.extend(
        file.debris
            .iter()
            .enumerate()
            .filter(|(_, piece)| piece.movable.is_some())
            .map(|(i, piece)| (i, piece.at)),
    );
    movable.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]).then(a.1[1].total_cmp(&b.1[1])).then(a.0.cmp(&b.0)));
    for pair in movable.windows(2).filter(|pair| pair[0].1.map(f64::to_bits) == pair[1].1.map(f64::to_bits)) {
        let rule = "must not be on the same point as another movable piece";
        check.fail(format!("debris[{}].at", pair[1].0), rule, format!("debris[{}]", pair[0].0));
    }
}

/// Checks that ground robots can reach every task's centre and every rescuee.
fn places(check: &mut Checker, file: &ScenarioFile) {
    for (i, piece) in file.debris.iter().enumerate().filter(|(_, piece)| piece.movable.is_none()) {
        covers(check, &format!("debris[{i}].at"), piece, file);
    }
    for (field, piece) in super::homes::later_pieces(file) {
        covers(check, &field, &piece, file);
    }
    for (i, wall) in file.walls.iter().enumerate() {
        for piece in wall.pieces() {
            covers(check, &format!("walls[{i}]"), &piece, file);
            let outline = piece.outline();
            for task in file.tasks.iter().filter(|task| is_in_the_way(&outline, task)) {
                check.fail(
                    format!("walls[{i}]"),
                    "must not go through a task's block of rescuees",
                    format!("task {}", task.name),
                );
            }
        }
    }
}

fn is_in_the_way(wall: &Outline, task: &TaskFile) -> bool {
    let block = DebrisFile::fixed(DebrisShape::Box(task.size_m[0], task.size_m[1]), task.center).outline();
    distance(&wall.pose, &*wall.shape, &block.pose, &*block.shape).is_ok_and(|found| found.distance <= 0.0)
}

/// Checks that a fixed piece covers no place that robots have to reach.
fn covers(check: &mut Checker, field: &str, piece: &DebrisFile, file: &ScenarioFile) {
    let outline = piece.outline();
    let depth = |at: Point| -f64::from(outline.signed_distance([at[0] as f32, at[1] as f32].into()));
    let smallest = file.smallest_on_the_ground_m();
    for task in &file.tasks {
        // A rest place may be covered. Robots then try the other rest places.
        if depth(task.center) > 0.0 {
            let [x, y] = task.center;
            check.fail(
                field,
                format!("must not cover the centre of task {}", task.name),
                format!("({x}, {y})"),
            );
            continue;
        }
        // How far a robot beside the piece reaches into it, in metres.
        let reach = file.mission.reach_m - smallest - file.planning.clearance_m;
        let half = task.size_m.map(|size| size / 2.0);
        let bounds = outline.shape.compute_aabb(&outline.pose);
        let is_far = (0..2).any(|k| {
            f64::from(bounds.mins[k]) > task.center[k] + half[k]
                || f64::from(bounds.maxs[k]) < task.center[k] - half[k]
        });
        let hidden = |at: &[f64; 2]| depth(*at) > reach.max(0.0);
        if !is_far && let Some([x, y]) = rescuees_of(task).find(hidden) {
            check.fail(
                field,
                format!("must not hide a rescuee of task {} from every robot's reach", task.name),
                format!("({x}, {y})"),
            );
        }
    }
}

/// Places of a task's rescuees: a regular grid.
fn rescuees_of(task: &TaskFile) -> impl Iterator<Item = Point> + '_ {
    let [columns, rows] = task.grid;
    let place = move |column: u32, row: u32| {
        let along = |k: usize, i: u32, count: u32| match count {
            0 | 1 => task.center[k],
            _ => task.center[k] + task.size_m[k] * (f64::from(i) / f64::from(count - 1) - 0.5),
        };
        [along(0, column, columns), along(1, row, rows)]
    };
    (0..rows).flat_map(move |row| (0..columns).map(move |column| place(column, row)))
}

impl ScenarioFile {
    /// Radius of the smallest robot on the ground that can carry, in metres.
    fn smallest_on_the_ground_m(&self) -> f64 {
        let bodies = self.team.iter().filter_map(|row| self.body_of(row));
        let able = bodies.filter(|body| body.kind == RoleKind::Ground && body.capacity > 0);
        able.map(|body| body.radius_m).fold(limits::ROBOT_RADIUS_M.most, f64::min)
    }
}
