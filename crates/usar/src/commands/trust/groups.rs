//! The groups of a team by a policy.

use experiments::experiment::PolicySpec;
use rne_core::LogBase;
use teaming::{Account, Decision};

use super::team::Team;
use crate::prelude::*;

/// Groups the team. A question in JSON is answered by the JSON of the decision.
pub(super) fn told(team: &Team, spec: &PolicySpec, is_json: bool) -> Result<Report, Failure> {
    let decision = spec.made().decide(&team.question).map_err(|error| team.failure(&error))?;
    decision
        .assignment
        .check(&team.question)
        .map_err(|error| Failure::run(format!("{}: {error}", spec.label)))?;
    if is_json && !team.is_table() {
        return Report::document(&decision);
    }
    let mut out = Report::default();
    out.show("groups", groups(team, &decision));
    out.rows("decision", [&decision])?;
    tell_account(&mut out, &decision, spec);
    out.extend(merges(team, &decision));
    Ok(out)
}

/// A row for each task, a column for each role.
fn groups(team: &Team, decision: &Decision) -> Table {
    let question = &team.question;
    let row = |task| {
        let group = decision.assignment.of(task);
        let of_role = move |role| {
            let members = question.of_role(role).filter(|member| group.contains(&member.id));
            let names: Vec<String> = members.map(|member| team.name(member.id)).collect();
            Entry::from(names.join(" ")).with(names)
        };
        labelled(&question.tasks[task.index()].name, question.role_ids().map(of_role))
    };
    Table::of(labelled("task", &question.roles), question.task_ids().map(row))
}

/// What the policy says of its decision.
fn tell_account(out: &mut Report, decision: &Decision, spec: &PolicySpec) {
    if let Some(score) = decision.score {
        let written = spec.options().iter().find(|(name, _)| name == "log_base");
        let base = written.and_then(|(_, base)| serde_json::from_value(base.as_str().into()).ok());
        let base: LogBase = base.unwrap_or_default();
        let value = score.in_base(base).map_or("infinite".to_owned(), |value| format!("{value:.9}"));
        out.say(format!("score   {value} (log base {base:?})"));
    }
    let options = &spec.made().options;
    if !options.is_empty() {
        out.say(format!("options {options}"));
    }
    if !decision.proven_optimal {
        out.say(
            "note: the team is too large to look at every grouping; this one was found by local search and \
             is not proven optimal",
        );
    }
}

/// In which order roles were merged, where that decides something.
fn merges(team: &Team, decision: &Decision) -> Option<String> {
    let Account::Rne(account) = &decision.account else { return None };
    let roles = team.question.roles.join(", ");
    (account.merges.len() > 1).then(|| {
        format!("merged  {roles}: the order in which the roles are first mentioned, which decides the merges")
    })
}
