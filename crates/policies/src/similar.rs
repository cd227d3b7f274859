//! `SIMILAR`: robots that trust one another work together: the least sum of RNE within groups.
//!
//! The opposite reading of trust in Yang & Parasuraman 2021, whose policy RNE sets groups apart. The sum goes
//! over all pairs of one role in one group; a pair counts with the mean of both relative entropies between
//! its needs distributions, that is, half of Jeffreys's divergence. An infinite one counts as 1,000 nats.
//! Exact up to 100,000 assignments of n robots, if n^2 for each of them is no more than 10^8; above that,
//! swaps from the order of the ids, in time n^2 for each pass.
//!
//! Example: four robots of a role with needs (1, 3), (3, 1), (1, 3), (3, 1), and two tasks of two slots: the
//! first and the third one work together, and so do the others, with a sum of 0.

use rne_core::divergence::jeffreys;
use rne_core::needs::{NeedDistribution, NeedWeights};
use teaming::decision::Decision;
use teaming::error::PolicyError;
use teaming::policy::Policy;
use teaming::question::{Member, Question};
use teaming::registry::PolicyKind;

use crate::assigning::{groups, of_role, slots};
use crate::searching::{Loss, least};

/// What a pair without any trust counts, in nats.
const NO_TRUST: f64 = 1_000.0;

/// The least distrust within groups. Of equal ones, the lower ids go to the harder tasks.
#[derive(Debug, Clone, Copy)]
pub struct Similar;

/// The registry's line.
#[must_use]
pub fn kind() -> PolicyKind {
    PolicyKind::plain("SIMILAR", "robots of a role that trust one another work together", Similar)
        .from_sources(env!("SOURCES_SIMILAR"))
}

impl Policy for Similar {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let mut start = vec![0; question.members.len()];
        for role in question.role_ids() {
            let members = of_role(question, role).into_iter();
            members.zip(slots(question, role)).for_each(|(member, task)| start[member] = task);
        }
        let mut within = Within::new(question)?;
        let (task_of, proven_optimal) = least(question, &mut within, start);
        Ok(Decision { proven_optimal, ..Decision::unscored(groups(question, &task_of)) })
    }
}

/// The distrust within groups.
struct Within {
    /// For each pair of members what it counts: 0 for two roles.
    pairs: Vec<Vec<f64>>,
    /// For each member and task, the sum of its pairs with the members of the task.
    sums: Vec<Vec<f64>>,
    total: f64,
}

impl Within {
    fn new(question: &Question) -> Result<Self, PolicyError> {
        let (members, tasks) = (&question.members, question.tasks.len());
        let mut pairs = vec![vec![0.0; members.len()]; members.len()];
        let shares = distributions(question)?;
        for role in question.role_ids() {
            let members = of_role(question, role);
            for (at, a) in members.iter().enumerate() {
                for b in &members[at + 1..] {
                    let both = jeffreys(&shares[*a], &shares[*b]).map_err(PolicyError::Options)?;
                    let mean = both.nats().map_or(NO_TRUST, |nats| (nats / 2.0).min(NO_TRUST));
                    (pairs[*a][*b], pairs[*b][*a]) = (mean, mean);
                }
            }
        }
        Ok(Self { sums: vec![vec![0.0; tasks]; members.len()], pairs, total: 0.0 })
    }
}

fn distributions(question: &Question) -> Result<Vec<NeedDistribution>, PolicyError> {
    let of_member = |member: &Member| {
        let weights = NeedWeights::new(question.weights());
        let shares = weights.and_then(|weights| NeedDistribution::of_agent(&member.needs, &weights));
        shares.map_err(|source| PolicyError::Needs { id: member.id, source })
    };
    question.members.iter().map(of_member).collect()
}

impl Loss for Within {
    fn steps(members: u64) -> u64 {
        members * members
    }

    fn begin(&mut self, task_of: &[usize]) {
        self.total = 0.0;
        for (member, (sums, pairs)) in self.sums.iter_mut().zip(&self.pairs).enumerate() {
            sums.fill(0.0);
            pairs.iter().zip(task_of).for_each(|(pair, task)| sums[*task] += pair);
            self.total += sums[task_of[member]] / 2.0;
        }
    }

    fn loss(&self, _: &[usize]) -> f64 {
        self.total
    }

    fn gain(&self, task_of: &[usize], [a, b]: [usize; 2]) -> f64 {
        let leaves = self.sums[a][task_of[a]] - self.sums[a][task_of[b]];
        let comes = self.sums[b][task_of[b]] - self.sums[b][task_of[a]];
        leaves + comes + 2.0 * self.pairs[a][b]
    }

    fn swap(&mut self, task_of: &[usize], [a, b]: [usize; 2]) {
        self.total -= self.gain(task_of, [a, b]);
        for (sums, pairs) in self.sums.iter_mut().zip(&self.pairs) {
            let moved = pairs[b] - pairs[a];
            sums[task_of[a]] += moved;
            sums[task_of[b]] -= moved;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::made_up::with_needs;

    #[test]
    fn the_example_by_hand() {
        let question = with_needs(&[&[1.0, 3.0], &[3.0, 1.0], &[1.0, 3.0], &[3.0, 1.0]], &[1, 2]);
        let decision = Similar.decide(&question).unwrap();
        assert_eq!(decision.assignment.groups, [[1, 3], [0, 2]]);
        assert!(decision.proven_optimal);
    }

    /// 44,850 assignments of 300 robots would take 4 * 10^9 steps.
    #[test]
    fn few_assignments_of_many_robots_are_not_all_looked_at() {
        let needs: Vec<[f64; 2]> = (0..300).map(|id| [1.0 + f64::from(id % 7), 2.0]).collect();
        let needs: Vec<&[f64]> = needs.iter().map(|needs| &needs[..]).collect();
        let mut question = with_needs(&needs, &[1, 2]);
        question.quotas[0].members = vec![298, 2];
        let decision = Similar.decide(&question).unwrap();
        assert!(!decision.proven_optimal && decision.assignment.groups[1].len() == 2);
    }
}
