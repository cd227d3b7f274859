//! The policy's view of an assignment: the RNE between its groups, need by need.

use serde::Serialize;

use super::scorer::{Scorer, add};
use super::{Rne, as_score, weighted_needs};
use rne_core::decision::Assignment;
use rne_core::divergence::relative_entropy_by_need;
use rne_core::error::PolicyError;
use rne_core::ids::TaskId;
use rne_core::needs::NeedDistribution;
use rne_core::question::Question;
use rne_core::trust::RelativeNeedsEntropy;

/// RNE from one group to another, and the contribution of each need.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DirectedRne {
    /// The task of the group that trusts.
    pub from: TaskId,
    /// The task of the group that is trusted.
    pub to: TaskId,
    /// The sum of `by_need`, in nats.
    pub rne: RelativeNeedsEntropy,
    /// For each need, its share in the first group's weighted needs, and in the second's.
    pub shares: Vec<[f64; 2]>,
    /// For each need, its contribution, in nats; `None` for a need that makes the value infinite.
    pub by_need: Vec<Option<f64>>,
}

impl Rne {
    /// The score of an assignment as this policy computes it: the sum over all pairs of groups, in nats.
    /// `None` where fewer than two groups have members.
    ///
    /// # Errors
    /// Those of [`rne_core::Policy::decide`].
    pub fn score(
        &self,
        question: &Question,
        assignment: &Assignment,
    ) -> Result<Option<RelativeNeedsEntropy>, PolicyError> {
        let mut sums = self.sums(question, assignment)?;
        // The order of the groups matters if the score has a direction. They are sorted by their smallest ids
        // of the first role, as the policy forms them.
        let first_role = question.role_ids().find(|role| question.of_role(*role).next().is_some());
        let smallest = |task: TaskId| {
            let members = first_role.into_iter().flat_map(|role| question.of_role(role));
            members
                .map(|member| member.id)
                .filter(|id| assignment.of(task).contains(id))
                .min()
                .unwrap_or(u32::MAX)
        };
        sums.sort_by_key(|(task, _)| smallest(*task));
        let sums: Vec<Vec<f64>> = sums.into_iter().map(|(_, sum)| sum).collect();
        Ok(as_score(Scorer::new(self.options.score, self.options.sort).total(&sums, 0)))
    }

    /// RNE between all pairs of groups that have members, in both directions, need by need. With the option
    /// `sort` the policy compares sorted shares instead, which belong to no need.
    ///
    /// # Errors
    /// Those of [`rne_core::Policy::decide`].
    pub fn directed(
        &self,
        question: &Question,
        assignment: &Assignment,
    ) -> Result<Vec<DirectedRne>, PolicyError> {
        let sums = self.sums(question, assignment)?;
        let mut found = Vec::new();
        for (from, first) in &sums {
            for (to, second) in sums.iter().filter(|(to, _)| to != from) {
                let distribution =
                    |sum| NeedDistribution::normalise("weighted needs", sum).map_err(PolicyError::Options);
                let (p, q) = (distribution(first)?, distribution(second)?);
                let by_need = relative_entropy_by_need(&p, &q).map_err(PolicyError::Options)?;
                let sum = by_need.iter().try_fold(0.0, |sum, need| Some(sum + (*need)?));
                let shares = p.shares().iter().zip(q.shares()).map(|(p, q)| [*p, *q]).collect();
                let rne = RelativeNeedsEntropy::from_nats(sum.unwrap_or(f64::INFINITY));
                found.push(DirectedRne { from: *from, to: *to, rne, shares, by_need });
            }
        }
        Ok(found)
    }

    /// The sum of the weighted needs of each group that has members.
    fn sums(
        &self,
        question: &Question,
        assignment: &Assignment,
    ) -> Result<Vec<(TaskId, Vec<f64>)>, PolicyError> {
        let rows = weighted_needs(question, &self.weights(question)?)?;
        let of_task = |task: TaskId| {
            let mut sum = vec![0.0; question.needs.len()];
            let group = assignment.of(task);
            let members = question.members.iter().zip(&rows).filter(|(member, _)| group.contains(&member.id));
            members.for_each(|(_, row)| add(&mut sum, row));
            (!group.is_empty()).then_some((task, sum))
        };
        Ok(question.task_ids().filter_map(of_task).collect())
    }
}
