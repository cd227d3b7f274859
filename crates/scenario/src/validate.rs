//! The rules of a scenario: every value is in its range, and the values are consistent.

use super::checker::{Checker, entry, is_device, meant, names, shown};
use super::debris::{ROUNDING_M, debris};
use super::deceit::deceit;
use super::errands::{errands, places_are_free};
use super::error::Problem;
use super::feasibility::feasibility;
use super::file::{Fidelity, Happening, Measure, NeedFile, RoleFile, RoleKind, ScenarioFile, TaskFile};
use super::homes::homes_are_free;
use super::ranges::in_range;
use super::rules::rules;
use super::scatter::scatter;
use super::telemetry::telemetry;
use super::timeline::timeline;
use super::words::Words;
use crate::limits;

/// All broken rules, in the order of the fields.
pub(super) fn problems(file: &ScenarioFile) -> Vec<Problem> {
    if !file.draws.is_empty() {
        return file.problems_of_draws();
    }
    let mut check = of_values(file);
    if check.problems.is_empty() {
        homes_are_free(&mut check, file); // these need sound shapes and places
        places_are_free(&mut check, file);
        feasibility(&mut check, file);
    }
    check.problems
}

/// The broken rules of the values one by one.
pub(super) fn problems_of_values(file: &ScenarioFile) -> Vec<Problem> {
    of_values(file).problems
}

fn of_values(file: &ScenarioFile) -> Checker {
    let mut check = Checker { problems: Vec::new(), arena: file.arena_m };
    if !(in_range(&mut check, &file.plain_tree()) && totals_are_sound(&mut check, file)) {
        return check; // the rules below take time with each entry
    }
    general(&mut check, file);
    team(&mut check, file);
    roles(&mut check, file);
    if file.errands.is_empty() {
        tasks(&mut check, file);
    } else {
        errands(&mut check, file);
    }
    debris(&mut check, file);
    sampled(&mut check, file);
    rules(&mut check, file);
    scatter(&mut check, file);
    telemetry(&mut check, file);
    deceit(&mut check, file);
    timeline(&mut check, file);
    needs(&mut check, file);
    words(&mut check, &file.words);
    check
}

/// Longest word of a scenario's own, in bytes.
const LONGEST_WORD: usize = 24;

/// Robots that may push debris go no farther than this in a step, in metres: the engine would push light
/// pieces into faster robots.
const PUSHING_STEP_M: f64 = 0.12;

/// Checks that each word is plain, and that no two things have one.
fn words(check: &mut Checker, words: &Words) {
    let is_plain = |word: &str| {
        word.len() <= LONGEST_WORD
            && word.starts_with(|c: char| c.is_ascii_lowercase())
            && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit())
    };
    let all = words.all();
    for (i, (field, word)) in all.iter().enumerate() {
        if !is_plain(word) {
            let rule = "must be a word of at most 24 small letters and digits that begins with a letter";
            check.fail(format!("words.{field}"), rule, shown(word));
        } else if *word == "energy" || all[..i].iter().any(|(_, other)| other == word) {
            check.fail(format!("words.{field}"), "must be a word that nothing else has", shown(word));
        }
    }
}

/// Checks what all entries together make. The time and memory of all later checks grow with it.
fn totals_are_sound(check: &mut Checker, file: &ScenarioFile) -> bool {
    let grid = |grid: &[u32; 2]| u64::from(grid[0]) * u64::from(grid[1]);
    let later = file.timeline.iter().filter_map(|moment| match &moment.event {
        Happening::RescueesAppear { grid, .. } => Some(grid),
        _ => None,
    });
    let rescuees = file.tasks.iter().map(|task| &task.grid).chain(later).map(grid);
    let rescuees = rescuees.fold(0, u64::saturating_add);
    let is_sound = |side: &u32| limits::GRID.allows(*side as usize);
    let are_sound = file.tasks.iter().flat_map(|task| &task.grid).all(is_sound);
    let robots: u64 = file.team.iter().map(|row| u64::from(row.count)).sum();
    let scattered: u64 = file.scatter.iter().map(|entry| u64::from(entry.count)).sum();
    let mut all_are_sound = true;
    for (table, limit, rule, total) in [
        ("team", limits::ROBOTS, "must have 1 to {} robots", robots),
        ("tasks", limits::RESCUEES, "must have at most {} rescuees in all", rescuees),
        ("scatter", limits::SCATTERED, "must place at most {} things in all", scattered),
    ] {
        if !limit.allows(total as usize) && (table != "tasks" || are_sound) {
            all_are_sound = false;
            check.fail(table, rule.replace("{}", &limit.most.to_string()), total);
        }
    }
    all_are_sound
}

fn general(check: &mut Checker, file: &ScenarioFile) {
    if file.format != super::FORMAT {
        let rule = format!("must be {}", super::FORMAT);
        let hint = if file.format > super::FORMAT { "it is of a newer program" } else { "" };
        check.fail_with("format", rule, hint.to_owned(), file.format);
    }
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    let is_name = limits::NAME_BYTES.allows(file.name.len()) && file.name.chars().all(plain);
    if !is_name || file.name.starts_with(['.', '-']) || file.name.ends_with('.') {
        let rule = "must be a name of at most 64 letters, digits, `-`, `_` and `.` that does not start with \
            `.` or `-` nor end with `.`";
        check.fail("name", rule, shown(&file.name));
    } else if is_device(&file.name) {
        check.fail("name", "must not be the name of a device on Windows", shown(&file.name));
    }
    if file.fidelity == Some(Fidelity::Coarse) {
        check.fail("fidelity", "must be left out: longer steps are a larger dt_s", "Coarse");
    }
}

fn team(check: &mut Checker, file: &ScenarioFile) {
    for (i, row) in file.team.iter().enumerate() {
        let field = format!("team[{i}]");
        let Some(role) = file.body_of(row) else {
            let known: Vec<&str> = file.roles.iter().map(|role| role.name.as_str()).collect();
            let rule = format!("must be one of the roles ({})", known.join(", "));
            check.fail_with(format!("{field}.role"), rule, meant(&row.role, known), shown(&row.role));
            continue;
        };
        let radius = role.radius_m;
        if row.body.is_some() {
            self::role(check, &format!("{field}.body"), &role, file);
        }
        if let Some(levels) = &row.levels {
            check.amount(&format!("{field}.levels.energy"), &levels.energy, limits::LEVEL);
            check.amount(&format!("{field}.levels.hp"), &levels.hp, limits::LEVEL);
        }
        check.inside(format!("{field}.center"), [row.center[0] - row.width_m / 2.0, row.center[1]], radius);
        check.inside(format!("{field}.center"), [row.center[0] + row.width_m / 2.0, row.center[1]], radius);
    }
}

fn roles(check: &mut Checker, file: &ScenarioFile) {
    names(check, "roles", file.roles.iter().map(|role| role.name.as_str()));
    for spec in &file.roles {
        role(check, &entry("roles", &spec.name), spec, file);
        for name in spec.constants.keys() {
            let is_need = |need: &NeedFile| need.name == *name && need.measures == Measure::Constant;
            if !file.needs.iter().any(is_need) {
                let field = format!("{}.constants", entry("roles", &spec.name));
                let constants = file.needs.iter().filter(|need| need.measures == Measure::Constant);
                let hint = meant(name, constants.map(|need| need.name.as_str()));
                check.fail_with(field, "must name needs that measure Constant", hint, shown(name));
            }
        }
    }
}

fn needs(check: &mut Checker, file: &ScenarioFile) {
    names(check, "needs", file.needs.iter().map(|need| need.name.as_str()));
    for need in &file.needs {
        let field = entry("needs", &need.name);
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
        let Some(role) = file.body_of(row) else { continue };
        if file.needs.iter().all(|need| need.weight * at_best(&role, need) == 0.0) {
            let must = format!("must weigh a need that robots of the role {} have", role.name);
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

fn role(check: &mut Checker, field: &str, spec: &RoleFile, file: &ScenarioFile) {
    let (dt, step_m) = (file.dt_s, spec.speed_mps * file.dt_s);
    if step_m > spec.radius_m + ROUNDING_M {
        let rule = format!(
            "times dt_s ({dt} s) must be at most radius_m ({} m), or contacts are missed",
            spec.radius_m
        );
        check.fail(format!("{field}.speed_mps"), rule, spec.speed_mps);
    } else if spec.kind == RoleKind::Ground && step_m > PUSHING_STEP_M + ROUNDING_M && file.can_be_pushed() {
        let rule = format!(
            "times dt_s ({dt} s) must be at most {PUSHING_STEP_M} m where debris can be pushed, or it is \
             pushed into robots"
        );
        check.fail(format!("{field}.speed_mps"), rule, spec.speed_mps);
    }
}

fn tasks(check: &mut Checker, file: &ScenarioFile) {
    if file.tasks.is_empty() {
        return check.fail("tasks", "must be given when there are no errands", "neither");
    }
    names(check, "tasks", file.tasks.iter().map(|task| task.name.as_str()));
    for task in &file.tasks {
        let field = entry("tasks", &task.name);
        task_area(check, &field, task);
        told_facts(check, &field, file, task);
        for role in task.quota.keys() {
            if !file.roles.iter().any(|known| known.name == *role) {
                let known = file.roles.iter().map(|role| role.name.as_str());
                let (rule, hint) = ("must name roles of the scenario", meant(role, known));
                check.fail_with(format!("{field}.quota"), rule, hint, shown(role));
            }
        }
    }
}

/// Checks what policies are told of a task.
fn told_facts(check: &mut Checker, field: &str, file: &ScenarioFile, task: &TaskFile) {
    for need in task.requires.keys() {
        if !file.needs.iter().any(|known| known.name == *need) {
            let known = file.needs.iter().map(|need| need.name.as_str());
            let (rule, hint) = ("must name needs of the scenario", meant(need, known));
            check.fail_with(format!("{field}.requires"), rule, hint, shown(need));
        }
    }
    for other in &task.after {
        if *other == task.name || !file.tasks.iter().any(|known| known.name == *other) {
            let known = file.tasks.iter().map(|task| task.name.as_str());
            let (rule, hint) = ("must name other tasks of the scenario", meant(other, known));
            check.fail_with(format!("{field}.after"), rule, hint, shown(other));
        }
    }
}

fn task_area(check: &mut Checker, field: &str, task: &TaskFile) {
    let [half_w, half_h] = task.size_m.map(|size| size / 2.0);
    for corner in [[-half_w, -half_h], [half_w, half_h]] {
        let corner = [task.center[0] + corner[0], task.center[1] + corner[1]];
        check.inside(format!("{field}.center"), corner, 0.0);
    }
    check.inside(format!("{field}.rest"), task.rest, 0.0);
}

/// Checks that each greatest radius is at least the least one.
fn sampled(check: &mut Checker, file: &ScenarioFile) {
    let sampled = &file.sampled;
    for (name, [least, greatest]) in
        [("debris_radius_m", sampled.debris_radius_m), ("zone_radius_m", sampled.zone_radius_m)]
    {
        check.at_least(&format!("sampled.{name}[1]"), greatest, least, limits::SAMPLED_RADIUS_M);
    }
}
