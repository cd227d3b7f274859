//! The groups of a team by a policy.

use experiments::experiment::PolicySpec;
use reports::table::headed;
use rne_core::{Account, Decision, LogBase, TaskId};
use serde_json::{Value, json};

use super::team::Team;
use crate::output::print_plain_json;
use crate::prelude::*;

/// Groups the team and prints the groups. A question in JSON is answered by the JSON of the decision.
pub(super) fn show(
    team: &Team,
    spec: &PolicySpec,
    is_json: bool,
    out: &mut dyn Write,
) -> Result<(), Failure> {
    let decision = spec.made().decide(&team.question).map_err(|error| team.failure(&error))?;
    decision
        .assignment
        .check(&team.question)
        .map_err(|error| Failure::run(format!("{}: {error}", spec.label)))?;
    match (is_json, team.is_table()) {
        (true, true) => print_json(&json!({
            "policy": spec.label,
            "groups": team.question.task_ids().map(|task| group(team, &decision, task)).collect::<Vec<_>>(),
            "decision": decision,
        })),
        (true, false) => print_plain_json(&decision),
        (false, _) => {
            print_groups(out, team, &decision)?;
            print_account(out, &decision, spec)?;
            print_merges(out, team, &decision)
        }
    }
}

fn group(team: &Team, decision: &Decision, task: TaskId) -> Value {
    let robots = decision.assignment.of(task).iter().map(|robot| team.name(*robot));
    json!({
        "task": team.question.tasks[task.index()].name,
        "robots": robots.collect::<Vec<String>>(),
    })
}

/// A row for each task, a column for each role.
fn print_groups(out: &mut dyn Write, team: &Team, decision: &Decision) -> Result<(), Failure> {
    let question = &team.question;
    let mut table = headed(["task"].into_iter().chain(question.roles.iter().map(String::as_str)));
    for task in question.task_ids() {
        let group = decision.assignment.of(task);
        let of_role = |role| {
            let members = question.of_role(role).filter(|member| group.contains(&member.id));
            members.map(|member| team.name(member.id)).collect::<Vec<String>>().join(" ")
        };
        let name = question.tasks[task.index()].name.clone();
        table.add_row([name].into_iter().chain(question.role_ids().map(of_role)));
    }
    print_table(out, &table)
}

/// What the policy says of its decision.
fn print_account(out: &mut dyn Write, decision: &Decision, spec: &PolicySpec) -> Result<(), Failure> {
    if let Some(score) = decision.score {
        let written = spec.options().iter().find(|(name, _)| name == "log_base");
        let base = written.and_then(|(_, base)| serde_json::from_value(base.as_str().into()).ok());
        let base: LogBase = base.unwrap_or_default();
        let value = score.in_base(base).map_or("infinite".to_owned(), |value| format!("{value:.9}"));
        writeln!(out, "score   {value} (log base {base:?})")?;
        print_bound(out, decision, base)?;
    }
    let options = &spec.made().options;
    if !options.is_empty() {
        writeln!(out, "options {options}")?;
    }
    if !decision.proven_optimal {
        writeln!(
            out,
            "note: the team is too large to look at every grouping; this one was found by local search and \
             is not proven optimal"
        )?;
    }
    Ok(())
}

/// In which order roles were merged, where that decides something.
fn print_merges(out: &mut dyn Write, team: &Team, decision: &Decision) -> Result<(), Failure> {
    let Account::Rne(account) = &decision.account else { return Ok(()) };
    if account.merges.len() < 2 {
        return Ok(());
    }
    let roles = team.question.roles.join(", ");
    Ok(writeln!(
        out,
        "merged  {roles}: the order in which the roles are first mentioned, which decides the merges"
    )?)
}

/// How far the score can be from the best one.
fn print_bound(out: &mut dyn Write, decision: &Decision, base: LogBase) -> Result<(), Failure> {
    let (Some(bound), Some(gap)) = (decision.upper_bound, decision.gap_percent) else { return Ok(()) };
    let bound = bound.in_base(base).map_or("infinite".to_owned(), |value| format!("{value:.9}"));
    let optimal = if decision.proven_optimal { ", optimal" } else { "" };
    Ok(writeln!(out, "bound   {bound} (gap {gap:.1} %{optimal})")?)
}
