//! Explanations of a decision: what drove it, how close it was, and what other policies would have decided.

use serde::Serialize;
use store::Failure;
use teaming::{Asked, Assignment, Decision, Question, TaskId, TeamTrust};

use crate::experiment::PolicySpec;

/// The choice of another policy.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OtherChoice {
    /// The policy.
    pub policy: String,
    /// Its assignment.
    pub assignment: Assignment,
    /// Robots that the policy would have sent to another task.
    pub moved: Vec<u32>,
    /// Why the answer would be refused, if it would be.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refused: Option<String>,
}

/// An exchange of two robots of one role, and the distrust between the groups after it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Exchange {
    /// The robot with which the robot changes places.
    pub with: u32,
    /// The distrust between the groups after the exchange; `None` if it is infinite.
    pub score: Option<f64>,
}

/// The distrust of one group towards another, and what each need adds to it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Directed {
    /// The task of the group that trusts.
    pub from: TaskId,
    /// The task of the group that is trusted.
    pub to: TaskId,
    /// In the unit of the measure; `None` if it is infinite.
    pub distrust: Option<f64>,
    /// For each need, its share in the first group's weighted needs, and in the second's.
    pub shares: Vec<[f64; 2]>,
    /// For each need, what it adds; `None` for a need that makes the distrust infinite.
    pub by_need: Vec<Option<f64>>,
}

/// The choice of each policy. The oracle and policies that cannot group this team are left out.
pub fn other_choices(asked: &Asked<'_>, chosen: &Assignment, policies: &[PolicySpec]) -> Vec<OtherChoice> {
    let choice = |spec: &PolicySpec| {
        let (question, assignment) =
            (asked.question, spec.made().open().ok()?.decide(asked).ok()?.assignment);
        let moved = |id: &u32| assignment.task_of(*id) != chosen.task_of(*id);
        let moved = question.members.iter().map(|member| member.id).filter(moved).collect();
        let refused = assignment.check(question).err().map(|error| error.to_string());
        Some(OtherChoice { policy: spec.label.clone(), assignment, moved, refused })
    };
    policies.iter().filter(|spec| spec.is_of_question()).filter_map(choice).collect()
}

/// The distrust between the groups of a decision, need by need, the direction with the larger value first.
/// Empty for a measure that does not go need by need.
///
/// # Errors
/// The needs cannot be compared.
pub fn directed(
    trust: &dyn TeamTrust,
    question: &Question,
    decision: &Decision,
) -> Result<Vec<Directed>, Failure> {
    let group = |task: TaskId| decision.assignment.of(task);
    let tasks: Vec<TaskId> = question.task_ids().filter(|task| !group(*task).is_empty()).collect();
    let mut found = Vec::new();
    for (from, to) in tasks.iter().flat_map(|from| tasks.iter().map(move |to| (*from, *to))) {
        if from == to {
            continue;
        }
        let parts = trust.by_need(group(from), group(to)).map_err(Failure::run)?;
        let Some(parts) = parts else { return Ok(Vec::new()) };
        let distrust = trust.towards(group(from), group(to)).map_err(Failure::run)?;
        found.push(Directed {
            from,
            to,
            distrust: finite(distrust),
            shares: parts.iter().map(|part| part.shares).collect(),
            by_need: parts.iter().map(|part| finite(part.adds)).collect(),
        });
    }
    let value = |pair: &Directed| pair.distrust.unwrap_or(f64::INFINITY);
    found.sort_by(|a, b| value(b).total_cmp(&value(a)));
    Ok(found)
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// The score if this robot had changed places with each other robot of its role in another group; the best
/// exchange first.
///
/// # Errors
/// The needs cannot be compared.
pub fn exchanges(
    trust: &dyn TeamTrust,
    question: &Question,
    assignment: &Assignment,
    robot: u32,
) -> Result<Vec<Exchange>, Failure> {
    let role = question.members.iter().find(|member| member.id == robot).map(|member| member.role);
    let others = question.members.iter().filter(|member| {
        Some(member.role) == role && assignment.task_of(member.id) != assignment.task_of(robot)
    });
    let exchange = |with: u32| {
        let swapped = |id: u32| match id {
            id if id == robot => with,
            id if id == with => robot,
            id => id,
        };
        let groups = assignment.groups.iter().map(|group| group.iter().copied().map(swapped).collect());
        let score = trust.between(&Assignment::new(groups.collect())).map_err(Failure::run)?;
        Ok(Exchange { with, score: score.and_then(finite) })
    };
    let mut found = others.map(|member| exchange(member.id)).collect::<Result<Vec<_>, Failure>>()?;
    let value = |exchange: &Exchange| exchange.score.unwrap_or(f64::INFINITY);
    found.sort_by(|a, b| value(b).total_cmp(&value(a)));
    Ok(found)
}
