//! Explanations of a decision: what drove it, how close it was, and what other policies would have decided.

use policies::rne::{DirectedRne, Rne};
use rne_core::{Assignment, Decision, Question};
use serde::Serialize;

use crate::experiment::PolicySpec;
use crate::failure::Failure;
use crate::oracle::NotSimulated;

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

/// An exchange of two robots of one role, and the policy's score after it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Exchange {
    /// The robot with which the robot changes places.
    pub with: u32,
    /// The score after the exchange, in nats; `None` if it is infinite.
    pub score_nats: Option<f64>,
}

/// The choice of each policy. The oracle and policies that cannot group this team are left out.
#[must_use]
pub fn other_choices(question: &Question, chosen: &Assignment, policies: &[PolicySpec]) -> Vec<OtherChoice> {
    let choice = |spec: &PolicySpec| {
        let assignment = spec.made().policy.decide(question).ok()?.assignment;
        let moved = |id: &u32| assignment.task_of(*id) != chosen.task_of(*id);
        let moved = question.members.iter().map(|member| member.id).filter(moved).collect();
        let refused = assignment.check(question).err().map(|error| error.to_string());
        Some(OtherChoice { policy: spec.label.clone(), assignment, moved, refused })
    };
    policies.iter().filter(|spec| spec.name != NotSimulated::NAME).filter_map(choice).collect()
}

/// The RNE policy with these options; `None` for a policy of another kind.
#[must_use]
pub fn rne_of(spec: &PolicySpec) -> Option<Rne> {
    Rne::new(spec.rne_options()?).ok()
}

/// RNE between the groups of a decision, need by need, the direction with the larger value first.
///
/// # Errors
/// The needs cannot be compared.
pub fn directed(rne: &Rne, question: &Question, decision: &Decision) -> Result<Vec<DirectedRne>, Failure> {
    let mut directed = rne.directed(question, &decision.assignment).map_err(Failure::run)?;
    directed.sort_by(|a, b| b.rne.partial_cmp(&a.rne).unwrap_or(std::cmp::Ordering::Equal));
    Ok(directed)
}

/// The score if this robot had changed places with each other robot of its role in another group; the best
/// exchange first.
///
/// # Errors
/// The needs cannot be compared.
pub fn exchanges(
    rne: &Rne,
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
        let score = rne.score(question, &Assignment::new(groups.collect())).map_err(Failure::run)?;
        Ok(Exchange { with, score_nats: score.and_then(rne_core::RelativeNeedsEntropy::nats) })
    };
    let mut found = others.map(|member| exchange(member.id)).collect::<Result<Vec<_>, Failure>>()?;
    let value = |exchange: &Exchange| exchange.score_nats.unwrap_or(f64::INFINITY);
    found.sort_by(|a, b| value(b).total_cmp(&value(a)));
    Ok(found)
}
