//! Whether the record of a trial that was read from a file fits the tables of its scenario. A record that fits
//! names only tasks, roles and robots that exist, and its counts and sums can be computed.

use rne_core::{Decision, Member, MemberOutcome, Question, RoundOutcome};
use ron_tree::Problem;

use crate::event::Event;
use crate::metrics::RoundRecord;
use crate::record::{RobotRecord, TrialRecord};
use crate::scenario::Scenario;

/// No result of a trial is as large as this: neither a time, nor a cost, nor a distance.
const MOST: f64 = 1e15;

/// The names and sizes of a scenario's tables.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tables<'a> {
    /// Names of the tasks.
    pub tasks: Vec<&'a str>,
    /// Names of the roles.
    pub roles: Vec<&'a str>,
    /// Number of the needs.
    pub needs: usize,
    /// Number of the robots.
    pub robots: usize,
}

type Fits = Result<(), Box<Problem>>;

/// Whether a value can be the result of a trial: it is finite, and not larger than any result.
///
/// ```
/// assert!(usar_sim::fit::is_result(-3.5));
/// assert!(!usar_sim::fit::is_result(1e300) && !usar_sim::fit::is_result(f64::NAN));
/// ```
pub fn is_result(value: f64) -> bool {
    value.abs() < MOST
}

fn fits(holds: bool, field: impl Into<String>, rule: impl Into<String>) -> Fits {
    if holds { Ok(()) } else { Err(Box::new(Problem::new(field, rule, ""))) }
}

/// Checks each entry of a list; the field of a problem is within the entry.
fn each<T>(field: &str, entries: &[T], check: impl Fn(&T) -> Fits) -> Fits {
    entries.iter().enumerate().try_for_each(|(i, entry)| {
        check(entry).map_err(|mut problem| {
            problem.field = format!("{field}[{i}].{}", problem.field);
            problem
        })
    })
}

/// Checks that a sum of counts is a count.
fn sum(field: &str, mut counts: impl Iterator<Item = u32>) -> Fits {
    let is_count = counts.try_fold(0_u32, u32::checked_add).is_some();
    fits(is_count, field, "must add up to less than 2^32")
}

fn results<const N: usize>(values: [(&str, f64); N]) -> Fits {
    let wrong = values.into_iter().find(|(_, value)| !is_result(*value));
    wrong.map_or(Ok(()), |(field, value)| {
        let rule = "must be smaller: no trial has such a result";
        Err(Box::new(Problem::new(field, rule, format!("{value:e}"))))
    })
}

impl<'a> Tables<'a> {
    /// The tables of a scenario.
    pub fn of(scenario: &'a Scenario) -> Self {
        Self {
            tasks: scenario.tasks.iter().map(|task| task.name.as_str()).collect(),
            roles: scenario.roles.iter().map(|role| role.name.as_str()).collect(),
            needs: scenario.needs.len(),
            robots: scenario.robots() as usize,
        }
    }

    fn task(&self, field: &str, task: usize) -> Fits {
        let tasks = self.tasks.len();
        let rule = format!("must be the number of a task, below {tasks}");
        if task < tasks { Ok(()) } else { Err(Box::new(Problem::new(field, rule, task))) }
    }

    fn robot(&self, field: &str, robot: u32) -> Fits {
        let rule = format!("must be the number of a robot, below {}", self.robots);
        if (robot as usize) < self.robots { Ok(()) } else { Err(Box::new(Problem::new(field, rule, robot))) }
    }

    /// Checks a decision: the question, its answer, and the members as they really were. The policy's account
    /// of its answer is its own matter.
    ///
    /// # Errors
    /// The first value that does not fit.
    pub fn check_decision(&self, question: &Question, decision: &Decision, truth: Option<&[Member]>) -> Fits {
        let tasks = question.tasks.iter().map(|task| task.name.as_str());
        fits(tasks.eq(self.tasks.iter().copied()), "question.tasks", "must be the tasks of the scenario")?;
        let roles = question.roles.iter().map(String::as_str);
        fits(roles.eq(self.roles.iter().copied()), "question.roles", "must be the roles of the scenario")?;
        let needs = question.needs.len() == self.needs;
        fits(needs, "question.needs", "must be the needs of the scenario")?;
        self.check_members(question)?;
        each("question.history", &question.history, |round| self.check_outcome(round))?;
        let answered = decision.assignment.check(question);
        answered
            .map_err(|wrong| Problem::new("decision.assignment", format!("does not fit: {wrong}"), ""))?;
        let Some(truth) = truth else { return Ok(()) };
        self.check_members(&Question { members: truth.to_vec(), ..question.clone() })?;
        let ids = |members: &[Member]| members.iter().map(|member| member.id).collect::<Vec<_>>();
        fits(ids(truth) == ids(&question.members), "truth", "must be of the members of the question")
    }

    fn check_members(&self, question: &Question) -> Fits {
        let is_sorted = question.members.is_sorted_by(|a, b| a.id < b.id);
        fits(is_sorted, "question.members", "must be in the order of their ids")?;
        question.members.iter().try_for_each(|member| self.robot("question.members.id", member.id))?;
        let checked = question.clone().checked();
        Ok(checked
            .map(drop)
            .map_err(|wrong| Problem::new("question", format!("does not fit: {wrong}"), ""))?)
    }

    /// Checks an event: the robots and tasks that it names.
    ///
    /// # Errors
    /// The first number that no robot or task has.
    pub fn check_event(&self, event: &Event) -> Fits {
        let named = match serde_json::to_value(event) {
            Ok(serde_json::Value::Object(kinds)) => kinds.into_iter().next().map(|(_, fields)| fields),
            _ => None,
        };
        let Some(named) = named else { return Ok(()) };
        let number = |value: &serde_json::Value| u32::try_from(value.as_u64()?).ok();
        for field in ["robot", "room_for", "resource_of"] {
            named[field]
                .as_u64()
                .map_or(Ok(()), |_| self.robot(field, number(&named[field]).unwrap_or(u32::MAX)))?;
        }
        let robots = named["robots"].as_array().into_iter().flatten().filter_map(number);
        robots.into_iter().try_for_each(|robot| self.robot("robots", robot))?;
        match event {
            Event::RoundStarted { groups, .. } => {
                fits(groups.len() == self.tasks.len(), "groups", "must have a group for each task")?;
                groups.iter().flatten().try_for_each(|robot| self.robot("groups", robot.0))
            }
            _ => named["task"].as_u64().map_or(Ok(()), |task| self.task("task", task as usize)),
        }
    }

    /// Checks the record of a trial.
    ///
    /// # Errors
    /// The first value that does not fit.
    pub fn check_record(&self, record: &TrialRecord) -> Fits {
        let tasks = record.tasks.iter().map(|task| task.task.as_str());
        fits(tasks.eq(self.tasks.iter().copied()), "tasks", "must be the tasks of the scenario")?;
        sum("tasks.secured", record.tasks.iter().map(|task| task.totals.secured))?;
        sum("tasks.rescued", record.tasks.iter().map(|task| task.totals.rescued))?;
        each("tasks", &record.tasks, |task| {
            results([("energy", task.totals.energy), ("hp", task.totals.hp)])
        })?;
        results([
            ("time_s", record.time_s),
            ("ungrouped_energy", record.ungrouped_energy),
            ("ungrouped_hp", record.ungrouped_hp),
        ])?;
        sum("rounds.rescued", record.rounds.iter().map(|round| round.rescued))?;
        sum("rounds.secured", record.rounds.iter().map(|round| round.secured))?;
        sum("rounds.turned_back", record.rounds.iter().map(|round| round.turned_back))?;
        each("rounds", &record.rounds, |round| self.check_round(round))?;
        each("ledger", &record.ledger, |round| self.check_outcome(round))?;
        each("decisions", &record.decisions, |asked| {
            self.check_decision(&asked.question, &asked.decision, asked.truth.as_deref())
        })?;
        fits(record.robots.len() == self.robots, "robots", "must be the robots of the scenario")?;
        let are_in_order = record.robots.iter().zip(0..).all(|(robot, id)| robot.robot == id);
        fits(are_in_order, "robots", "must be in the order of their numbers")?;
        each("robots", &record.robots, |robot| self.check_robot(robot))?;
        each("cut_off", &record.cut_off, |cut_off| self.robot("robot", cut_off.robot))
    }

    fn check_round(&self, round: &RoundRecord) -> Fits {
        fits(round.round > 0, "round", "must be counted from 1")?;
        self.task("task", round.task.index())?;
        results([
            ("start_s", round.start_s),
            ("end_s", round.end_s.unwrap_or_default()),
            ("energy", round.energy),
            ("hp", round.hp),
        ])?;
        each("members", &round.members, |member| self.check_member(member))
    }

    fn check_outcome(&self, round: &RoundOutcome) -> Fits {
        fits(round.groups.len() == self.tasks.len(), "groups", "must have a group for each task")?;
        results([("duration_s", round.duration_s)])?;
        each("groups", &round.groups, |group| {
            self.task("task", group.task.index())?;
            results([("energy", group.energy), ("hp", group.hp)])?;
            each("members", &group.members, |member| self.check_member(member))
        })
    }

    fn check_member(&self, member: &MemberOutcome) -> Fits {
        self.robot("id", member.id)?;
        results([("energy", member.energy), ("hp", member.hp)])
    }

    fn check_robot(&self, robot: &RobotRecord) -> Fits {
        fits(self.roles.contains(&robot.role.as_str()), "role", "must be a role of the scenario")?;
        results([
            ("initial_energy", robot.initial_energy),
            ("initial_hp", robot.initial_hp),
            ("final_energy", robot.final_energy),
            ("final_hp", robot.final_hp),
            ("energy_spent", robot.energy_spent),
            ("hp_lost", robot.hp_lost),
            ("distance_m", robot.distance_m),
            ("waiting_s", robot.waiting_s),
            ("longest_stall_s", robot.longest_stall_s),
        ])?;
        robot.stall.waits_for.map_or(Ok(()), |other| self.robot("stall.waits_for", other.0))
    }
}
