//! Whether the record of a trial that was read from a file fits the tables of its scenario. A record that
//! fits names only tasks, roles and robots that exist, and its counts and sums can be computed.

use ron_tree::Problem;
use scenario::Scenario;
use serde_json::Value;
use teaming::{Assignment, Decision, Member, MemberOutcome, Question, RoundOutcome, TaskId};

use crate::event::Event;
use crate::record::{DecisionRecord, Join, TaskRecord, TrialRecord};

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

/// Checks that something is the number of one of so many things.
fn number(what: &str, count: usize, field: &str, found: u64) -> Fits {
    let rule = format!("must be the number of a {what}, below {count}");
    if found < count as u64 { Ok(()) } else { Err(Box::new(Problem::new(field, rule, found))) }
}

/// Checks that fields of a record can be results of a trial.
macro_rules! results {
    ($record:ident: $($field:ident)+) => {
        [$((stringify!($field), $record.$field)),+].into_iter().try_for_each(|(field, value)| {
            let rule = "must be smaller: no trial has such a result";
            let wrong = || Box::new(Problem::new(field, rule, format!("{value:e}")));
            is_result(value).then_some(()).ok_or_else(wrong)
        })
    };
}

/// The numbers in a value, in lists and in lists of lists.
fn numbers(value: &Value) -> Vec<u64> {
    let inside = value.as_array().into_iter().flatten().flat_map(numbers);
    value.as_u64().into_iter().chain(inside).collect()
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

    fn task(&self, field: &str, task: TaskId) -> Fits {
        number("task", self.tasks.len(), field, task.0.into())
    }

    fn robot(&self, field: &str, robot: u32) -> Fits {
        number("robot", self.robots, field, robot.into())
    }

    /// Checks a decision: the question, its answer, how robots decided, and the members as they really were.
    /// The policy's account of its answer is its own matter.
    ///
    /// # Errors
    /// The first value that does not fit.
    pub fn check_decision(
        &self,
        question: &Question,
        decision: &Decision,
        joins: &[Join],
        truth: Option<&[Member]>,
    ) -> Fits {
        let tasks = question.tasks.iter().map(|task| task.name.as_str());
        fits(tasks.eq(self.tasks.iter().copied()), "question.tasks", "must be the tasks of the scenario")?;
        let roles = question.roles.iter().map(String::as_str);
        fits(roles.eq(self.roles.iter().copied()), "question.roles", "must be the roles of the scenario")?;
        let needs = question.needs.len() == self.needs;
        fits(needs, "question.needs", "must be the needs of the scenario")?;
        self.check_members(question)?;
        each("question.history", &question.history, |round| self.check_outcome(round))?;
        let answered = decision.assignment.check(question);
        if joins.is_empty() {
            let rule = |wrong| format!("does not fit: {wrong}");
            answered.map_err(|wrong| Problem::new("decision.assignment", rule(wrong), ""))?;
        } else {
            self.check_joins(decision, joins)?;
        }
        let Some(truth) = truth else { return Ok(()) };
        self.check_members(&Question { members: truth.to_vec(), ..question.clone() })?;
        let ids = |members: &[Member]| members.iter().map(|member| member.id).collect::<Vec<_>>();
        fits(ids(truth) == ids(&question.members), "truth", "must be of the members of the question")
    }

    /// Checks that the groups are those that the robots joined.
    fn check_joins(&self, decision: &Decision, joins: &[Join]) -> Fits {
        let Assignment { groups, idle } = &decision.assignment;
        let grouped = groups.iter().chain([idle]).map(Vec::len).sum::<usize>();
        groups.iter().chain([idle]).flatten().try_for_each(|robot| self.robot("groups", *robot))?;
        let joined = |join: &Join| decision.assignment.task_of(join.robot) == join.sees.task_of(join.robot);
        let is_sum = groups.len() == self.tasks.len() && grouped == joins.len();
        fits(is_sum && joins.iter().all(joined), "decision.assignment", "must be what the robots joined")?;
        each("joins", joins, |join| {
            fits(join.sees.groups.len() == self.tasks.len(), "sees", "must have a group for each task")?;
            let seen = join.sees.groups.iter().chain([&join.sees.idle]).flatten();
            seen.chain([&join.robot]).try_for_each(|robot| self.robot("sees", *robot))
        })
    }

    fn check_members(&self, question: &Question) -> Fits {
        let is_sorted = question.members.is_sorted_by(|a, b| a.id < b.id);
        fits(is_sorted, "question.members", "must be in the order of their ids")?;
        question.members.iter().try_for_each(|member| self.robot("question.members.id", member.id))?;
        let checked = question.clone().checked().map(drop);
        Ok(checked.map_err(|wrong| Problem::new("question", format!("does not fit: {wrong}"), ""))?)
    }

    /// Checks an event: the robots and tasks that it names.
    ///
    /// # Errors
    /// The first number that no robot or task has.
    pub fn check_event(&self, event: &Event) -> Fits {
        let kinds = serde_json::to_value(event).unwrap_or_default();
        let named = kinds.as_object().and_then(|kinds| kinds.values().next()).unwrap_or(&Value::Null);
        let (tasks, groups) = (self.tasks.len(), named["groups"].as_array());
        let is_grouped = groups.is_none_or(|groups| groups.len() == tasks);
        fits(is_grouped, "groups", "must have a group for each task")?;
        for field in ["robot", "room_for", "resource_of", "robots", "groups"] {
            let mut found = numbers(&named[field]).into_iter();
            found.try_for_each(|found| number("robot", self.robots, field, found))?;
        }
        named["task"].as_u64().map_or(Ok(()), |found| number("task", tasks, "task", found))
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
        each("tasks", &record.tasks, |TaskRecord { totals, .. }| results!(totals: energy hp))?;
        results!(record: time_s ungrouped_energy ungrouped_hp)?;
        sum("rounds.rescued", record.rounds.iter().map(|round| round.rescued))?;
        sum("rounds.secured", record.rounds.iter().map(|round| round.secured))?;
        sum("rounds.turned_back", record.rounds.iter().map(|round| round.turned_back))?;
        each("rounds", &record.rounds, |round| {
            fits(round.round > 0, "round", "must be counted from 1")?;
            self.task("task", round.task)?;
            fits(round.end_s.is_none_or(is_result), "end_s", "must be smaller: no trial has such a result")?;
            results!(round: start_s energy hp)?;
            each("members", &round.members, |member| self.check_member(member))
        })?;
        each("ledger", &record.ledger, |round| self.check_outcome(round))?;
        each("decisions", &record.decisions, |asked| {
            let DecisionRecord { question, decision, truth, joins } = asked;
            self.check_decision(question, decision, joins, truth.as_deref())
        })?;
        fits(record.robots.len() == self.robots, "robots", "must be the robots of the scenario")?;
        let are_in_order = record.robots.iter().zip(0..).all(|(robot, id)| robot.robot == id);
        fits(are_in_order, "robots", "must be in the order of their numbers")?;
        each("robots", &record.robots, |robot| {
            fits(self.roles.contains(&robot.role.as_str()), "role", "must be a role of the scenario")?;
            results!(robot: initial_energy initial_hp final_energy final_hp energy_spent hp_lost)?;
            results!(robot: distance_m waiting_s longest_stall_s)?;
            robot.stall.waits_for.map_or(Ok(()), |other| self.robot("stall.waits_for", other.0))
        })?;
        each("cut_off", &record.cut_off, |cut_off| self.robot("robot", cut_off.robot))
    }

    fn check_outcome(&self, round: &RoundOutcome) -> Fits {
        fits(round.groups.len() == self.tasks.len(), "groups", "must have a group for each task")?;
        results!(round: duration_s)?;
        each("groups", &round.groups, |group| {
            self.task("task", group.task)?;
            results!(group: energy hp)?;
            each("members", &group.members, |member| self.check_member(member))
        })
    }

    fn check_member(&self, member: &MemberOutcome) -> Fits {
        self.robot("id", member.id)?;
        results!(member: energy hp)
    }
}
