//! `RNE`: groups by Relative Needs Entropy (the paper's Algorithms 1 to 5), with each ambiguity as a named
//! option.
//!
//! Each role is split into one part per task, so that the RNE between the parts is largest. Then the roles
//! are merged one after the other, in the order of their table, by the matching with the largest RNE between
//! the merged groups. The score of more than two groups is the sum over their pairs. The [`HardRule`] decides
//! which group takes which task.

mod gain;
mod group;
mod local;
mod measure;
mod merge;
mod options;
mod partition;
mod parts;
mod quotas;
mod scorer;
mod suitability;

pub use measure::measure_kind;
pub use merge::EXACT_TASKS;
pub use options::{HardRule, MergeReading, RneOptions, ScoreDirection};
pub use partition::EXACT_PARTITIONS;

use group::Group;
use merge::{Merge, Merger};
use partition::best_partition;
use quotas::Sizes;
use rne_core::NeedsError;
use rne_core::needs::{NeedWeights, check_length};
use rne_core::trust::RelativeNeedsEntropy;
use scorer::{Scorer, part_sums};
use teaming::decision::{
    Account, Alternative, Assignment, Decision, MatchingCandidate, RneAccount, RoleMerge, RoleSplit,
    SplitCandidate, Suitability,
};
use teaming::error::PolicyError;
use teaming::ids::RoleId;
use teaming::policy::Policy;
use teaming::question::{Member, Question};
use teaming::registry::PolicyKind;

const NAME: &str = "RNE";

/// The registry's line for the policy.
#[must_use]
pub fn kind() -> PolicyKind {
    PolicyKind::with_options(NAME, "the largest Relative Needs Entropy between the groups", Rne::new)
        .from_sources(env!("SOURCES_RNE"))
}

/// The RNE policy.
#[derive(Debug, Clone)]
pub struct Rne {
    options: RneOptions,
}

impl Rne {
    /// Takes the options.
    ///
    /// # Errors
    /// The weights in the options are not valid.
    pub fn new(options: RneOptions) -> Result<Self, NeedsError> {
        if let Some(weights) = &options.weights {
            NeedWeights::new(weights.clone())?;
        }
        Ok(Self { options })
    }

    /// The weight of each need for this team: from the options or else from the question. With the option
    /// `scale`, each weight is divided by the need's maximum over the team. A need that is 0 for all robots
    /// then gets weight 0.
    ///
    /// # Errors
    /// The number of weights differs from the number of needs.
    pub fn weights(&self, question: &Question) -> Result<Vec<f64>, PolicyError> {
        let mut weights = self.unscaled_weights(question)?;
        if self.options.scale {
            scale_by_maximum(&mut weights, &question.members);
        }
        Ok(weights)
    }

    fn unscaled_weights(&self, question: &Question) -> Result<Vec<f64>, PolicyError> {
        let weights = self.options.weights.clone().unwrap_or_else(|| question.weights());
        check_length("weights", question.needs.len(), weights.len()).map_err(PolicyError::Options)?;
        Ok(weights)
    }
}

/// Divides each weight by the need's maximum over the team.
fn scale_by_maximum(weights: &mut [f64], members: &[Member]) {
    for (k, weight) in weights.iter_mut().enumerate() {
        let maximum = members.iter().map(|member| member.needs.values()[k]).fold(0.0, f64::max);
        *weight = if maximum > 0.0 { *weight / maximum } else { 0.0 };
    }
}

/// The weighted needs of each member, in the order of the question.
fn weighted_needs(question: &Question, weights: &[f64]) -> Result<Vec<Vec<f64>>, PolicyError> {
    let row = |member: &Member| member.needs.values().iter().zip(weights).map(|(n, w)| n * w).collect();
    let rows: Vec<Vec<f64>> = question.members.iter().map(row).collect();
    for (row, member) in rows.iter().zip(&question.members) {
        let sum: f64 = row.iter().sum();
        let source = if sum == 0.0 {
            NeedsError::AllZero { what: "weighted needs" }
        } else if !sum.is_normal() || !(sum * rows.len() as f64).is_finite() {
            NeedsError::Overflow { found: sum }
        } else {
            continue;
        };
        return Err(PolicyError::Needs { id: member.id, source });
    }
    Ok(rows)
}

/// The state of the search for one answer.
struct Search<'q> {
    question: &'q Question,
    rne: &'q Rne,
    rows: Vec<Vec<f64>>,
    scorer: Scorer,
    sizes: Sizes,
    account: RneAccount,
    proven_optimal: bool,
}

impl Policy for Rne {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let weights = self.weights(question)?;
        let mut search = Search {
            question,
            rne: self,
            rows: weighted_needs(question, &weights)?,
            scorer: Scorer::new(self.options.score, self.options.sort),
            sizes: Sizes::of(question),
            account: RneAccount { weights, splits: Vec::new(), merges: Vec::new(), suitability: Vec::new() },
            proven_optimal: true,
        };
        let mut last = None;
        let mut groups: Option<Vec<Group>> = None;
        for role in question.role_ids().filter(|role| question.of_role(*role).next().is_some()) {
            let parts = search.split(role);
            groups = Some(match groups {
                None => parts,
                Some(merged) => search.merge(role, &merged, &parts, &mut last),
            });
        }
        let Some(groups) = groups else {
            return Ok(Decision::unscored(vec![Vec::new(); question.tasks.len()]));
        };
        search.finish(&groups, last.as_deref())
    }
}

impl Search<'_> {
    /// The parts of a role.
    fn split(&mut self, role: RoleId) -> Vec<Group> {
        let members = &self.question.members;
        let of_role: Vec<usize> = (0..members.len()).filter(|i| members[*i].role == role).collect();
        let rows: Vec<Vec<f64>> = of_role.iter().map(|i| self.rows[*i].clone()).collect();
        let split = best_partition(&rows, &self.question.quotas[role.index()].members, &mut self.scorer);
        self.proven_optimal &= split.proven_optimal;
        let mut part_of = vec![0; rows.len()];
        for (part, members) in split.parts.iter().enumerate() {
            members.iter().for_each(|i| part_of[*i] = part);
        }
        let sums = part_sums(&rows, &part_of, split.parts.len());
        let group = |(part, sum): (&Vec<usize>, Vec<f64>)| Group {
            members: part.iter().map(|i| of_role[*i]).collect(),
            sum,
        };
        let groups: Vec<Group> = split.parts.iter().zip(sums).map(group).collect();

        let ids = |part: &Vec<usize>| part.iter().map(|i| members[of_role[*i]].id).collect::<Vec<u32>>();
        let named = |parts: &Vec<Vec<usize>>| parts.iter().map(ids).collect();
        let candidate = |(parts, score)| SplitCandidate { parts: named(&parts), score: as_score(score) };
        let score = self.total(&groups); // of the parts in this order, should the score have a direction
        self.account.splits.push(RoleSplit {
            role,
            parts: named(&split.parts),
            score,
            runner_up: split.runner_up.map(candidate),
            searched: split.searched,
            proven_optimal: split.proven_optimal,
        });
        groups
    }

    /// Merges the groups so far with the parts of a role. `last` receives the groups of the runner-up of this
    /// merge; after the last merge, it holds that merge's.
    fn merge(
        &mut self,
        role: RoleId,
        groups: &[Group],
        parts: &[Group],
        last: &mut Option<Vec<Group>>,
    ) -> Vec<Group> {
        let merger = Merger { groups, parts, reading: self.rne.options.merge, sizes: &self.sizes };
        let Merge { matching, score, runner_up, proven_optimal } = merger.best(&mut self.scorer);
        let joined = merger.merged(&matching);
        *last = runner_up.as_ref().map(|(matching, _)| merger.merged(matching));
        self.proven_optimal &= proven_optimal;
        let candidate = |(matching, score)| MatchingCandidate { matching, score: as_score(score) };
        let runner_up = runner_up.map(candidate);
        self.account.merges.push(RoleMerge {
            role,
            matching,
            score: as_score(score),
            runner_up,
            proven_optimal,
        });
        joined
    }

    fn total(&mut self, groups: &[Group]) -> Option<RelativeNeedsEntropy> {
        let sums: Vec<&[f64]> = groups.iter().map(|group| group.sum.as_slice()).collect();
        as_score(self.scorer.total(&sums, 0))
    }

    /// Assigns the groups to tasks by the hard rule. Also returns the suitability of each group.
    fn placed(&mut self, groups: &[Group]) -> Result<(Assignment, Vec<Suitability>), PolicyError> {
        let values = self.rne.suitabilities(self.question, groups, &self.rows, &mut self.scorer)?;
        let tasks = suitability::tasks(self.question, groups, &values, &self.sizes);
        let members = &self.question.members;
        let mut by_task = vec![Vec::new(); self.question.tasks.len()];
        for (group, task) in groups.iter().zip(&tasks) {
            by_task[task.index()] = group.members.iter().map(|i| members[*i].id).collect();
        }
        Ok((Assignment::new(by_task), suitability::account(&tasks, &values)))
    }

    /// Assigns the groups to tasks and makes the decision. Its alternative is the assignment of the runner-up
    /// of the last merge.
    fn finish(mut self, groups: &[Group], last: Option<&[Group]>) -> Result<Decision, PolicyError> {
        let (assignment, suitability) = self.placed(groups)?;
        let score = self.total(groups);
        let mut alternatives = Vec::new();
        if let Some(groups) = last {
            let (assignment, _) = self.placed(groups)?;
            alternatives.push(Alternative { assignment, score: self.total(groups) });
        }
        self.account.suitability = suitability;
        let mut decision = Decision::of(assignment);
        decision.score = score;
        decision.proven_optimal = self.proven_optimal;
        decision.alternatives = alternatives;
        decision.account = Account::Rne(self.account);
        Ok(decision)
    }
}

/// A sum of scores; `None` if there are no two groups with members.
fn as_score(nats: f64) -> Option<RelativeNeedsEntropy> {
    (nats != f64::NEG_INFINITY).then(|| RelativeNeedsEntropy::from_nats(nats))
}
