//! The matrices of trust at a decision: between robots, and between groups.

use policies::RneOptions;
use policies::rne::Rne;
use rne_core::decision::Account;
use rne_core::{NeedDistribution, NeedVector, NeedWeights, Question, relative_entropy};
use serde::{Deserialize, Serialize};
use usar_sim::record::DecisionRecord;

/// A larger team has a matrix of its groups only.
const MOST_ROBOTS: usize = 64;

/// Relative Needs Entropy in nats from each row to each column. Low values are high trust; `None` is
/// infinite.
type Matrix = Vec<Vec<Option<f64>>>;

/// The trust between robots and between groups when a decision was made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trust {
    /// The weight of each need. These are the weights of the policy's account, or else those of the
    /// question, each divided by the largest need.
    pub weights: Vec<f64>,
    /// Ids of the members, in the order of the rows and columns of `robots`. Empty for a large team.
    pub members: Vec<u32>,
    /// From robot to robot, in nats.
    pub robots: Matrix,
    /// From group to group, in nats; a group without members trusts no group.
    pub groups: Matrix,
}

impl Trust {
    /// The matrices of a decision; `None` if needs give no distribution.
    pub(crate) fn of(decided: &DecisionRecord) -> Option<Self> {
        let DecisionRecord { question, decision, .. } = decided;
        let weights = match &decision.account {
            Account::Rne(account) => account.weights.clone(),
            _ => Rne::new(RneOptions::default()).ok()?.weights(question).ok()?,
        };
        let weights = NeedWeights::new(weights).ok()?;
        let is_small = question.members.len() <= MOST_ROBOTS;
        let members = question.members.iter().filter(|_| is_small);
        let robots: Vec<Option<NeedDistribution>> =
            members.clone().map(|member| NeedDistribution::of_agent(&member.needs, &weights).ok()).collect();
        let group = |ids: &Vec<u32>| NeedDistribution::of_group(&needs_of(question, ids), &weights).ok();
        let groups: Vec<Option<NeedDistribution>> = decision.assignment.groups.iter().map(group).collect();
        Some(Self {
            members: members.map(|member| member.id).collect(),
            robots: matrix(&robots),
            groups: matrix(&groups),
            weights: weights.values().to_vec(),
        })
    }
}

fn needs_of(question: &Question, ids: &[u32]) -> Vec<NeedVector> {
    let members = question.members.iter().filter(|member| ids.contains(&member.id));
    members.map(|member| member.needs.clone()).collect()
}

fn matrix(distributions: &[Option<NeedDistribution>]) -> Matrix {
    let towards = |p: &Option<NeedDistribution>, q: &Option<NeedDistribution>| {
        let nats = relative_entropy(p.as_ref()?, q.as_ref()?).ok()?.nats()?;
        Some((nats * 1e9).round() / 1e9)
    };
    distributions.iter().map(|p| distributions.iter().map(|q| towards(p, q)).collect()).collect()
}
