//! The matrices of trust at a decision: between robots, and between groups.

use serde::{Deserialize, Serialize};
use teaming::{MadeMeasure, TeamTrust};
use usar_sim::record::DecisionRecord;

/// A larger team has a matrix of its groups only.
const MOST_ROBOTS: usize = 64;

/// Distrust from each row to each column. Low values are high trust; `None` is infinite.
type Matrix = Vec<Vec<Option<f64>>>;

/// The trust between robots and between groups when a decision was made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trust {
    /// Label of the trust measure; empty in recordings from before there were others than RNE.
    #[serde(default)]
    pub measure: String,
    /// Unit of its values.
    #[serde(default)]
    pub unit: String,
    /// The weight of each need, as the measure uses it; empty for a measure without weights.
    pub weights: Vec<f64>,
    /// Ids of the members, in the order of the rows and columns of `robots`. Empty for a large team.
    pub members: Vec<u32>,
    /// From robot to robot.
    pub robots: Matrix,
    /// From group to group; a group without members trusts no group.
    pub groups: Matrix,
}

impl Trust {
    /// The matrices of a decision; `None` if the measure cannot measure in this team.
    pub(crate) fn of(decided: &DecisionRecord, measure: &MadeMeasure) -> Option<Self> {
        let DecisionRecord { question, decision, .. } = decided;
        let trust = measure.it.of_team(question).ok()?;
        let is_small = question.members.len() <= MOST_ROBOTS;
        let members: Vec<u32> =
            question.members.iter().filter(|_| is_small).map(|member| member.id).collect();
        let alone: Vec<Vec<u32>> = members.iter().map(|id| vec![*id]).collect();
        Some(Self {
            measure: measure.label.clone(),
            unit: measure.it.unit().to_owned(),
            members,
            robots: matrix(&*trust, &alone),
            groups: matrix(&*trust, &decision.assignment.groups),
            weights: trust.weights().to_vec(),
        })
    }
}

fn matrix(trust: &dyn TeamTrust, groups: &[Vec<u32>]) -> Matrix {
    let towards = |from: &[u32], to: &[u32]| {
        let value = trust.towards(from, to).ok().filter(|value| value.is_finite())?;
        Some((value * 1e9).round() / 1e9)
    };
    groups.iter().map(|from| groups.iter().map(|to| towards(from, to)).collect()).collect()
}
