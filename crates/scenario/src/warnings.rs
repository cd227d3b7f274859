//! Values that are allowed but unusual: far from the defaults, perhaps given in another unit; a team with
//! fewer robots than tasks; or a row that changes nothing.

use ron_tree::Node;

use super::Scenario;
use super::defaults::control_period_s;
use super::error::Problem;
use super::file::{MissionRules, PlanningRules, RoleFile, RoleKind};
use super::steps::{CONTROL_WAY_M, USUAL_STEP_S};
use super::telemetry::ReportRules;
use super::timeline::{Happening, Moment};

/// A value is odd if it is larger or smaller than the default by this factor.
const FACTOR: f64 = 1000.0;

impl Scenario {
    /// Values that are a thousand times larger or smaller than the defaults, perhaps by a wrong unit; a team
    /// smaller than the number of tasks; and rows that change nothing. The lines are those in `text`.
    pub fn warnings(&self, text: &str) -> Vec<Problem> {
        let tree = Node::parse(text).ok();
        let mut warnings = Vec::new();
        if (self.robots() as usize) < self.tasks.len() {
            warnings.push(Problem {
                field: "team".to_owned(),
                rule: format!("has fewer robots than there are tasks, {}", self.tasks.len()),
                found: self.robots().to_string(),
                hint: "each round leaves tasks without anybody".to_owned(),
                ..Problem::default()
            });
        }
        let role = numbers(&RoleFile::default());
        for (i, own) in self.roles.iter().enumerate() {
            // Ranges and counts of roles differ by design, so only properties that are similar for all robots
            // are compared.
            let usual = ["radius_m", "mass_kg", "speed_mps", "acceleration_mps2"];
            let own = numbers(own).into_iter().filter(|(name, _)| usual.contains(&name.as_str()));
            compare(&mut warnings, &format!("roles[{i}]"), own, &role);
        }
        let mission = numbers(&MissionRules::default());
        compare(&mut warnings, "mission", numbers(&self.mission).into_iter(), &mission);
        let planning = numbers(&PlanningRules::default());
        compare(&mut warnings, "planning", numbers(&self.planning).into_iter(), &planning);
        self.without_guide(&mut warnings);
        self.too_narrow(&mut warnings);
        self.without_effect(&mut warnings);
        self.again(&mut warnings);
        self.paid_by_the_step(&mut warnings);
        self.decides_at_other_times(&mut warnings);
        self.heard_too_late(&mut warnings);
        if self.fidelity.is_some() {
            warnings.push(Problem {
                field: "fidelity".to_owned(),
                rule: "has no effect any more".to_owned(),
                found: "AsWritten".to_owned(),
                hint: "all trials are simulated in steps of dt_s: leave it out".to_owned(),
                ..Problem::default()
            });
        }
        for problem in &mut warnings {
            problem.line = tree.as_ref().and_then(|tree| tree.line(&problem.field));
        }
        warnings
    }

    /// Costs per step of a scenario with another step than that for which such costs are written.
    fn paid_by_the_step(&self, warnings: &mut Vec<Problem>) {
        let (dt_s, costs) = (self.dt_s, &self.costs);
        if (dt_s - USUAL_STEP_S).abs() < 1e-9 {
            return;
        }
        for (name, rate) in [("energy", costs.energy.per_step), ("hp", costs.hp.per_step)] {
            if rate > 0.0 {
                let times = USUAL_STEP_S / dt_s;
                warnings.push(Problem {
                    field: format!("costs.{name}.per_step"),
                    rule: format!("is paid in every step, here of {dt_s} s"),
                    found: rate.to_string(),
                    hint: format!(
                        "in a second this is {times:.3} times as much as with steps of {USUAL_STEP_S} s; \
                         per_second does not depend on dt_s"
                    ),
                    ..Problem::default()
                });
            }
        }
    }

    /// A given control period that robots do not keep to.
    fn decides_at_other_times(&self, warnings: &mut Vec<Problem>) {
        let (given, step_s) = (self.control_period_s, self.dt_s);
        let kept = self.control_steps() as f64 * step_s;
        if [control_period_s(), kept].iter().all(|usual| (given - usual).abs() > 1e-9) {
            warnings.push(Problem {
                field: "control_period_s".to_owned(),
                rule: format!("is not kept to: robots decide every {kept:.4} s"),
                found: given.to_string(),
                hint: format!(
                    "it is rounded down to whole steps of {step_s} s, at least one, and nobody goes farther \
                     than {CONTROL_WAY_M} m between two decisions"
                ),
                ..Problem::default()
            });
        }
    }

    /// A medium over which messages are heard after the trial, or ever later.
    fn heard_too_late(&self, warnings: &mut Vec<Problem>) {
        let Some(medium) = &self.medium else { return };
        let mut say = |field: &str, rule: String, found: f64, hint: &str| {
            let (field, found, hint) = (field.to_owned(), found.to_string(), hint.to_owned());
            warnings.push(Problem { field, rule, found, hint, ..Problem::default() });
        };
        if medium.delay_s >= self.duration_s {
            let rule = format!("is as long as the trial or longer: it ends after {} s", self.duration_s);
            say("medium.delay_s", rule, medium.delay_s, "no message is ever heard");
        }
        let Some(kbps) = medium.kbps else { return };
        let every_s = self.reports.as_ref().map_or_else(|| ReportRules::default().every_s, |it| it.every_s);
        let on_air_s = (f64::from(medium.bytes) * 8.0 / kbps + medium.overhead_ms) / 1000.0;
        let share = f64::from(self.robots()) * on_air_s / every_s;
        if share > 1.0 {
            let rule = format!("is {share:.1} times too slow for the reports of all robots");
            say("medium.kbps", rule, kbps, "messages wait for one another, and are heard ever later");
        }
    }

    /// Robots that fly in a team in which nobody guides.
    fn without_guide(&self, warnings: &mut Vec<Problem>) {
        let loss = self.mission.blind_speed_loss;
        let flies = |(body, count): &(RoleFile, u32)| body.kind == RoleKind::Aerial && *count > 0;
        let Some((aerial, _)) = self.bodies().find(flies) else { return };
        if loss == 0.0 || self.tasks.is_empty() || self.bodies().any(|(body, _)| body.guides) {
            return;
        }
        let role = self.roles.iter().position(|role| role.name == aerial.name).unwrap_or_default();
        warnings.push(Problem {
            field: format!("roles[{role}].guides"),
            rule: format!("leaves the team without a guide: every group loses {loss} of its speed"),
            found: "false".to_owned(),
            hint: "`guides: true` lets a role guide its group (mission.blind_speed_loss)".to_owned(),
            ..Problem::default()
        });
    }

    /// Doors through which no robot fits.
    fn too_narrow(&self, warnings: &mut Vec<Problem>) {
        let widths = self.bodies().map(|(body, _)| 2.0 * (body.radius_m + self.planning.clearance_m));
        let Some(least) = widths.min_by(f64::total_cmp) else { return };
        for (i, wall) in self.walls.iter().enumerate() {
            for (k, door) in wall.doors.iter().enumerate().filter(|(_, door)| door.width_m < least) {
                warnings.push(Problem {
                    field: format!("walls[{i}].doors[{k}].width_m"),
                    rule: "is too narrow for every robot".to_owned(),
                    found: door.width_m.to_string(),
                    hint: format!("the smallest robot, with its clearance, takes {least:.2} m"),
                    ..Problem::default()
                });
            }
        }
    }

    /// Rows that change nothing, and doors that stay closed.
    fn without_effect(&self, warnings: &mut Vec<Problem>) {
        let mut say = |field: String, rule: String, found: String, hint: &str| {
            warnings.push(Problem { field, rule, found, hint: hint.to_owned(), ..Problem::default() });
        };
        for (i, row) in self.team.iter().enumerate().filter(|(_, row)| row.count == 0) {
            let rule = format!("gives the team no {}", row.role);
            say(format!("team[{i}].count"), rule, row.count.to_string(), "the row can be left out");
        }
        let late = |moment: &Moment| moment.at_s > self.duration_s;
        for (i, moment) in self.timeline.iter().enumerate().filter(|(_, moment)| late(moment)) {
            let rule = format!("is after the end of the trial, {} s", self.duration_s);
            say(format!("timeline[{i}].at_s"), rule, moment.at_s.to_string(), "it never happens");
        }
        let opens =
            |name: &str| self.timeline.iter().any(|moment| moment.event == Happening::Opens(name.to_owned()));
        for (i, wall) in self.walls.iter().enumerate() {
            for (k, door) in wall.doors.iter().enumerate().filter(|(_, door)| door.is_closed) {
                if !door.name.as_deref().is_some_and(opens) {
                    let rule = "closes the door for good: no event opens it".to_owned();
                    say(format!("walls[{i}].doors[{k}].closed"), rule, "true".to_owned(), "");
                }
            }
        }
    }
    /// Tasks that begin while they are open, or end while they are closed, or begin again.
    fn again(&self, warnings: &mut Vec<Problem>) {
        for task in &self.tasks {
            let (mut is_open, mut was_open) = (!self.begins_later(task), false);
            for (i, moment) in self.moments() {
                let (begins, name) = match &moment.event {
                    Happening::TaskBegins(name) => (true, name),
                    Happening::TaskEnds(name) => (false, name),
                    _ => continue,
                };
                if *name != task.name {
                    continue;
                }
                let rule = match (begins, is_open) {
                    (true, true) => "changes nothing: the task is open already",
                    (false, false) => "changes nothing: the task is over already",
                    (true, false) if was_open => "opens the task again: its own rescuees do not appear again",
                    _ => "",
                };
                (is_open, was_open) = (begins, was_open || is_open);
                if !rule.is_empty() {
                    let (field, found) = (format!("timeline[{i}].event"), format!("{name:?}"));
                    warnings.push(Problem { field, rule: rule.to_owned(), found, ..Problem::default() });
                }
            }
        }
    }
}

/// The numbers of a section, by the names of their fields.
fn numbers(section: &impl serde::Serialize) -> Vec<(String, f64)> {
    let Ok(tree) = Node::of(section) else { return Vec::new() };
    let leaves = tree.leaves().into_iter();
    leaves.filter_map(|(path, leaf)| Some((path, leaf.as_word()?.parse().ok()?))).collect()
}

fn compare(
    warnings: &mut Vec<Problem>,
    section: &str,
    own: impl Iterator<Item = (String, f64)>,
    usual: &[(String, f64)],
) {
    for (name, value) in own {
        let Some((_, default)) = usual.iter().find(|(known, _)| *known == name) else { continue };
        let ratio = value / default;
        let is_odd = value > 0.0 && *default > 0.0 && (ratio >= FACTOR || ratio <= 1.0 / FACTOR);
        if is_odd {
            let (times, than) = if ratio > 1.0 { (ratio, "times") } else { (1.0 / ratio, "times less than") };
            warnings.push(Problem {
                field: format!("{section}.{name}"),
                rule: format!("is {times:.0} {than} the default, {default}"),
                found: value.to_string(),
                hint: "is the unit right?".to_owned(),
                ..Problem::default()
            });
        }
    }
}
