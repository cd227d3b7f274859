//! The rules of a scenario: every value in its range, and the values in keeping with one another.

use std::fmt::Display;
use std::ops::RangeInclusive;

use rne_core::question::MAX_TASKS;

use super::error::Problem;
use super::file::{
    DebrisShape, Measure, NeedFile, Normal, Point, RoleFile, RoleKind, Row, SampledCounts, ScenarioFile,
    TaskFile,
};
use crate::vitals::Rates;

/// Most roles that a scenario may have.
const MAX_ROLES: usize = 64;

/// Most needs that a scenario may have.
const MAX_NEEDS: usize = 64;

/// All broken rules, in the order of the fields.
pub(super) fn problems(file: &ScenarioFile) -> Vec<Problem> {
    let mut check = Checker { problems: Vec::new(), arena: file.arena_m };
    general(&mut check, file);
    team(&mut check, file);
    roles(&mut check, file);
    levels(&mut check, file);
    if file.errands.is_empty() {
        tasks(&mut check, file);
    } else {
        errands(&mut check, file);
    }
    debris(&mut check, file);
    sampled(&mut check, file);
    rules(&mut check, file);
    needs(&mut check, file);
    if check.problems.is_empty() {
        homes_are_free(&mut check, file); // needs sound shapes and places
    }
    check.problems
}

struct Checker {
    problems: Vec<Problem>,
    arena: Point,
}

impl Checker {
    fn fail(&mut self, field: impl Into<String>, rule: impl Into<String>, found: impl Display) {
        let (field, rule, found) = (field.into(), rule.into(), found.to_string());
        self.problems.push(Problem { field, line: None, rule, found });
    }

    fn number(&mut self, field: impl Into<String>, value: f64, range: RangeInclusive<f64>) {
        if !range.contains(&value) {
            let rule = format!("must be a number from {} to {}", range.start(), range.end());
            self.fail(field, rule, value);
        }
    }

    fn count(&mut self, field: impl Into<String>, value: u32, range: RangeInclusive<u32>) {
        if !range.contains(&value) {
            self.fail(field, format!("must be a count from {} to {}", range.start(), range.end()), value);
        }
    }

    /// A point at least `margin` metres inside the arena.
    fn inside(&mut self, field: impl Into<String>, point: Point, margin: f64) {
        let fits = |x: f64, size: f64| x >= margin && x <= size - margin;
        if !fits(point[0], self.arena[0]) || !fits(point[1], self.arena[1]) {
            let rule = format!("must lie in the arena, at least {margin} m from its walls");
            self.fail(field, rule, format!("({}, {})", point[0], point[1]));
        }
    }
}

fn general(check: &mut Checker, file: &ScenarioFile) {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    if file.name.is_empty() || file.name.starts_with(['.', '-']) || !file.name.chars().all(plain) {
        let rule = "must be a name of letters, digits, `-`, `_` and `.` that does not start with `.` or `-`";
        check.fail("name", rule, format!("{:?}", file.name));
    }
    check.number("duration_s", file.duration_s, 1.0..=86_400.0);
    check.number("dt_s", file.dt_s, 0.001..=0.05);
    check.number("arena_m[0]", file.arena_m[0], 2.0..=20_000.0);
    check.number("arena_m[1]", file.arena_m[1], 2.0..=20_000.0);
}

fn team(check: &mut Checker, file: &ScenarioFile) {
    let total: u64 = file.team.iter().map(|row| u64::from(row.count)).sum();
    if total == 0 || total > 20_000 {
        check.fail("team", "must have 1 to 20000 robots", total);
        return;
    }
    for (i, row) in file.team.iter().enumerate() {
        let field = format!("team[{i}]");
        let Some(role) = role_of(file, row) else {
            let known: Vec<&str> = file.roles.iter().map(|role| role.name.as_str()).collect();
            let rule = format!("must be one of the roles ({})", known.join(", "));
            check.fail(format!("{field}.role"), rule, format!("{:?}", row.role));
            continue;
        };
        let radius = role.radius_m;
        check.number(format!("{field}.width_m"), row.width_m, 0.0..=20_000.0);
        if let Some(levels) = row.levels {
            check.number(format!("{field}.levels.energy"), levels.energy, 0.01..=100.0);
            check.number(format!("{field}.levels.hp"), levels.hp, 0.01..=100.0);
        }
        check.inside(format!("{field}.center"), [row.center[0] - row.width_m / 2.0, row.center[1]], radius);
        check.inside(format!("{field}.center"), [row.center[0] + row.width_m / 2.0, row.center[1]], radius);
    }
}

/// The role of a row, if it is one of the scenario's.
fn role_of<'f>(file: &'f ScenarioFile, row: &Row) -> Option<&'f RoleFile> {
    file.roles.iter().find(|role| role.name == row.role)
}

/// Names of a table: each plain, and each once.
fn names<'n>(check: &mut Checker, table: &str, most: usize, names: impl Iterator<Item = &'n str>) {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
    let mut seen: Vec<&str> = Vec::new();
    for (i, name) in names.enumerate() {
        if name.is_empty() || name.len() > 64 || name.starts_with('-') || !name.chars().all(plain) {
            let rule =
                "must be a name of at most 64 letters, digits, `-` and `_` that does not start with `-`";
            check.fail(format!("{table}[{i}].name"), rule, format!("{name:?}"));
        } else if seen.contains(&name) {
            check.fail(format!("{table}[{i}].name"), "must not be listed twice", format!("{name:?}"));
        }
        seen.push(name);
    }
    if seen.is_empty() || seen.len() > most {
        check.fail(table, format!("must have 1 to {most} entries"), seen.len());
    }
}

/// Path of an entry of a table: by its name, which is how people find it.
fn entry(table: &str, name: &str) -> String {
    format!("{table}.{name}")
}

fn roles(check: &mut Checker, file: &ScenarioFile) {
    names(check, "roles", MAX_ROLES, file.roles.iter().map(|role| role.name.as_str()));
    for spec in &file.roles {
        role(check, &entry("roles", &spec.name), spec, file.dt_s);
        for name in spec.constants.keys() {
            let is_need = |need: &NeedFile| need.name == *name && need.measures == Measure::Constant;
            if !file.needs.iter().any(is_need) {
                let field = format!("{}.constants", entry("roles", &spec.name));
                check.fail(field, "must name needs that measure Constant", format!("{name:?}"));
            }
        }
    }
}

fn needs(check: &mut Checker, file: &ScenarioFile) {
    names(check, "needs", MAX_NEEDS, file.needs.iter().map(|need| need.name.as_str()));
    for need in &file.needs {
        let field = entry("needs", &need.name);
        check.number(format!("{field}.weight"), need.weight, 0.0..=1e9);
        let lacks = |role: &&RoleFile| !role.constants.contains_key(&need.name);
        if need.measures == Measure::Constant
            && let Some(role) = file.roles.iter().find(lacks)
        {
            let rule = format!(
                "measures Constant, so that each role must have `constants: {{{:?}: ...}}`",
                need.name
            );
            check.fail(field, rule, format!("role {:?} without it", role.name));
        }
    }
    for row in &file.team {
        let Some(role) = role_of(file, row) else { continue };
        if file.needs.iter().all(|need| need.weight * at_best(role, need) == 0.0) {
            let must = format!("must weigh a need that a {} has", role.name);
            check.fail("needs", must, "weights of 0 for all of them");
        }
    }
}

/// The value of a need of a fresh robot.
fn at_best(role: &RoleFile, need: &NeedFile) -> f64 {
    match need.measures {
        Measure::Health => role.hp,
        Measure::Speed => role.speed_mps,
        Measure::Sensing => role.sensing_m,
        Measure::Energy => role.energy,
        Measure::Resources => f64::from(role.resources),
        Measure::Capacity => f64::from(role.capacity),
        Measure::Observing => role.observing_m,
        Measure::Constant => role.constants.get(&need.name).copied().unwrap_or(0.0),
    }
}

fn role(check: &mut Checker, field: &str, spec: &RoleFile, dt: f64) {
    check.number(format!("{field}.radius_m"), spec.radius_m, 0.05..=5.0);
    check.number(format!("{field}.mass_kg"), spec.mass_kg, 0.1..=10_000.0);
    check.number(format!("{field}.hp"), spec.hp, 0.001..=1e6);
    check.number(format!("{field}.energy"), spec.energy, 0.001..=1e6);
    check.number(format!("{field}.speed_mps"), spec.speed_mps, 0.05..=20.0);
    check.number(format!("{field}.acceleration_mps2"), spec.acceleration_mps2, 0.05..=100.0);
    check.number(format!("{field}.sensing_m"), spec.sensing_m, 0.0..=1000.0);
    check.number(format!("{field}.observing_m"), spec.observing_m, 0.0..=1000.0);
    check.count(format!("{field}.capacity"), spec.capacity, 0..=10_000);
    check.count(format!("{field}.resources"), spec.resources, 0..=10_000);
    for (name, value) in &spec.constants {
        check.number(format!("{field}.constants.{name:?}"), *value, 0.0..=1e9);
    }
    if spec.speed_mps * dt > spec.radius_m {
        let rule = format!(
            "times dt_s ({dt} s) must be at most radius_m ({} m), or contacts are missed",
            spec.radius_m
        );
        check.fail(format!("{field}.speed_mps"), rule, spec.speed_mps);
    }
}

fn levels(check: &mut Checker, file: &ScenarioFile) {
    let mut normal = |field: &str, Normal { mean, sd }: Normal| {
        check.number(format!("{field}.mean"), mean, 0.0..=100.0);
        check.number(format!("{field}.sd"), sd, 0.0..=100.0);
    };
    normal("initial_levels.energy", file.initial_levels.energy);
    normal("initial_levels.hp", file.initial_levels.hp);
}

fn tasks(check: &mut Checker, file: &ScenarioFile) {
    if file.tasks.is_empty() {
        return check.fail("tasks", "must be given when there are no errands", "neither");
    }
    names(check, "tasks", MAX_TASKS, file.tasks.iter().map(|task| task.name.as_str()));
    for task in &file.tasks {
        let field = entry("tasks", &task.name);
        task_area(check, &field, task);
        check.count(format!("{field}.difficulty"), task.difficulty, 0..=1_000_000);
        check.count(format!("{field}.sampled.debris"), task.sampled.debris, 0..=10_000);
        check.count(format!("{field}.sampled.radiation"), task.sampled.radiation, 0..=10_000);
        for (role, quota) in &task.quota {
            check.count(format!("{field}.quota.{role:?}"), *quota, 0..=20_000);
            if !file.roles.iter().any(|known| known.name == *role) {
                check.fail(format!("{field}.quota"), "must name roles of the scenario", format!("{role:?}"));
            }
        }
    }
}

fn errands(check: &mut Checker, file: &ScenarioFile) {
    let robots: u32 = file.team.iter().map(|row| row.count).sum();
    let mut last: Vec<(u32, Point)> = Vec::new();
    for (i, errand) in file.errands.iter().enumerate() {
        if errand.robot >= robots {
            let rule = format!("must be the id of one of the {robots} robots");
            check.fail(format!("errands[{i}].robot"), rule, errand.robot);
        } else if last.iter().any(|(robot, _)| *robot == errand.robot) {
            check.fail(format!("errands[{i}].robot"), "must not stand twice", errand.robot);
        }
        for (k, place) in errand.to.iter().enumerate() {
            check.inside(format!("errands[{i}].to[{k}]"), *place, 0.0);
        }
        match errand.to.last() {
            Some(place) => last.push((errand.robot, *place)),
            None => check.fail(format!("errands[{i}].to"), "must name at least one place", "none"),
        }
    }
    let samples = |task: &&TaskFile| task.sampled != SampledCounts::default();
    if let Some(task) = file.tasks.iter().find(samples) {
        check.fail(
            format!("{}.sampled", entry("tasks", &task.name)),
            "must be absent where there are errands: it fills the ways to tasks",
            "counts above 0",
        );
    }
}

fn task_area(check: &mut Checker, field: &str, task: &TaskFile) {
    check.number(format!("{field}.size_m[0]"), task.size_m[0], 0.0..=10_000.0);
    check.number(format!("{field}.size_m[1]"), task.size_m[1], 0.0..=10_000.0);
    check.count(format!("{field}.grid[0]"), task.grid[0], 0..=1000);
    check.count(format!("{field}.grid[1]"), task.grid[1], 0..=1000);
    let [half_w, half_h] = task.size_m.map(|size| size / 2.0);
    for corner in [[-half_w, -half_h], [half_w, half_h]] {
        let corner = [task.center[0] + corner[0], task.center[1] + corner[1]];
        check.inside(format!("{field}.center"), corner, 0.0);
    }
    check.inside(format!("{field}.rest"), task.rest, 0.0);
}

fn debris(check: &mut Checker, file: &ScenarioFile) {
    if file.debris.len() > 100_000 {
        check.fail("debris", "must have at most 100000 entries", file.debris.len());
        return;
    }
    for (i, piece) in file.debris.iter().enumerate() {
        let field = format!("debris[{i}]");
        match &piece.shape {
            DebrisShape::Disc(radius) => check.number(format!("{field}.shape"), *radius, 0.05..=100.0),
            DebrisShape::Box(width, height) => {
                check.number(format!("{field}.shape"), *width, 0.1..=1000.0);
                check.number(format!("{field}.shape"), *height, 0.1..=1000.0);
            }
            DebrisShape::Polygon(corners) => polygon(check, &format!("{field}.shape"), corners),
        }
        check.inside(format!("{field}.at"), piece.at, 0.0);
        check.number(format!("{field}.rotation_deg"), piece.rotation_deg, -360.0..=360.0);
        if let Some(movable) = piece.movable {
            check.number(format!("{field}.movable.mass_kg"), movable.mass_kg, 0.1..=100_000.0);
            check.number(format!("{field}.movable.friction"), movable.friction, 0.0..=10.0);
        }
    }
    for (i, zone) in file.radiation.iter().enumerate() {
        check.inside(format!("radiation[{i}].at"), zone.at, 0.0);
        check.number(format!("radiation[{i}].radius_m"), zone.radius_m, 0.01..=1000.0);
    }
}

fn polygon(check: &mut Checker, field: &str, corners: &[Point]) {
    if !(3..=64).contains(&corners.len()) {
        return check.fail(field, "must have 3 to 64 corners", corners.len());
    }
    if let Some(bad) = corners.iter().flatten().find(|x| !(-1000.0..=1000.0).contains(*x)) {
        return check.fail(field, "must have corners within 1000 m of its origin", bad);
    }
    for i in 0..corners.len() {
        let [a, b, c] = [0, 1, 2].map(|k| corners[(i + k) % corners.len()]);
        let turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
        if turn < 1e-4 {
            let rule = "must be convex, with its corners anticlockwise and none on a straight line";
            return check.fail(
                field,
                rule,
                format!("corner {} at ({}, {})", (i + 1) % corners.len(), b[0], b[1]),
            );
        }
    }
}

fn sampled(check: &mut Checker, file: &ScenarioFile) {
    let sampled = &file.sampled;
    for (name, [least, greatest]) in
        [("debris_radius_m", sampled.debris_radius_m), ("zone_radius_m", sampled.zone_radius_m)]
    {
        check.number(format!("sampled.{name}[0]"), least, 0.05..=100.0);
        check.number(format!("sampled.{name}[1]"), greatest, least..=100.0);
    }
    check.number("sampled.gap_m", sampled.gap_m, 0.0..=100.0);
    check.number("sampled.strip_m", sampled.strip_m, 0.1..=10_000.0);
}

fn rules(check: &mut Checker, file: &ScenarioFile) {
    let mut rates = |field: &str, rates: &Rates| {
        check.number(format!("{field}.per_step"), rates.per_step, 0.0..=100.0);
        check.number(format!("{field}.per_metre"), rates.per_metre, 0.0..=100.0);
        check.number(format!("{field}.per_second"), rates.per_second, 0.0..=100.0);
    };
    rates("costs.energy", &file.costs.energy);
    rates("costs.hp", &file.costs.hp);
    let mission = &file.mission;
    check.number("mission.energy_threshold", mission.energy_threshold, 0.0..=99.0);
    check.number("mission.hp_threshold", mission.hp_threshold, 0.0..=99.0);
    check.number("mission.rest_reserve", mission.rest_reserve, 0.0..=10.0);
    check.number("mission.rest_s", mission.rest_s, 0.0..=86_400.0);
    check.number("mission.loading_s", mission.loading_s, 0.0..=3600.0);
    let least_reach = file.least_reach_m();
    check.number("mission.reach_m", mission.reach_m, least_reach..=20.0);
    check.number("mission.area_margin_m", mission.area_margin_m, least_reach..=1000.0);
    check.number("mission.blind_speed_loss", mission.blind_speed_loss, 0.0..=0.95);
    check.number("mission.health_floor", mission.health_floor, 0.05..=1.0);
    check.number("mission.cut_off_s", mission.cut_off_s, 1.0..=86_400.0);
    check.number("planning.clearance_m", file.planning.clearance_m, 0.02..=10.0);
    check.number("planning.exposure_price_m", file.planning.exposure_price_m, 0.0..=1e6);
    check.number("conflicts.margin_m", file.conflicts.margin_m, 0.0..=10.0);
    check.number("conflicts.horizon_s", file.conflicts.horizon_s, 0.0..=60.0);
    check.count("conflicts.deadlock_steps", file.conflicts.deadlock_steps, 1..=100_000);
}

impl ScenarioFile {
    /// Least reach that lets a robot load a rescuee next to another robot: its own radius.
    fn least_reach_m(&self) -> f64 {
        let carrying = self.roles.iter().filter(|role| role.capacity > 0);
        carrying.map(|role| role.radius_m).fold(0.0, f64::max)
    }
}

/// No home on another home of its layer, nor inside debris (aerial robots fly over it).
fn homes_are_free(check: &mut Checker, file: &ScenarioFile) {
    let mut homes: Vec<(usize, &RoleFile, Point)> = Vec::new();
    for (i, row) in file.team.iter().enumerate() {
        homes.extend(
            role_of(file, row).into_iter().flat_map(|role| row.places().map(move |at| (i, role, at))),
        );
    }
    homes.sort_by(|a, b| a.2[0].total_cmp(&b.2[0]));
    let widest = file.roles.iter().map(|role| role.radius_m).fold(0.0, f64::max);
    for (i, (row, role, at)) in homes.iter().enumerate() {
        let near = homes[i + 1..].iter().take_while(|other| other.2[0] - at[0] < 2.0 * widest);
        for (_, other_role, other) in near.filter(|other| other.1.kind == role.kind) {
            let distance = libm::hypot(at[0] - other[0], at[1] - other[1]);
            let needed = role.radius_m + other_role.radius_m;
            if distance < needed {
                let rule = format!("must leave at least {needed} m between the centres of two robots");
                check.fail(
                    format!("team[{row}]"),
                    rule,
                    format!("{distance:.3} m at ({}, {})", at[0], at[1]),
                );
            }
        }
    }
    for (i, piece) in file.debris.iter().enumerate() {
        let outline = piece.outline();
        for (_, role, at) in homes.iter().filter(|home| home.1.kind == RoleKind::Ground) {
            if outline.distance_to([at[0] as f32, at[1] as f32].into()) < role.radius_m as f32 {
                check.fail(
                    format!("debris[{i}].at"),
                    "must leave every robot's home free",
                    format!("a home at ({}, {})", at[0], at[1]),
                );
            }
        }
    }
}
