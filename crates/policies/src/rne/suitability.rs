//! Which group takes which task: the best-suited group takes the hardest one.

use super::group::Group;
use super::options::HardRule;
use super::quotas::Sizes;
use super::scorer::{Scorer, TIE_TOLERANCE};
use super::{Rne, scale_by_maximum};
use crate::facts::missing;
use teaming::decision::Suitability;
use teaming::error::PolicyError;
use teaming::ids::TaskId;
use teaming::levels::{ENERGY, HP};
use teaming::question::{Member, Question};

impl Rne {
    /// How well each group is suited for a hard task: higher is better, `None` for an empty group.
    pub(super) fn suitabilities(
        &self,
        question: &Question,
        groups: &[Group],
        rows: &[Vec<f64>],
        scorer: &mut Scorer,
    ) -> Result<Vec<Option<f64>>, PolicyError> {
        let mut scaled = self.unscaled_weights(question)?;
        scale_by_maximum(&mut scaled, &question.members);
        let value = |group: &Group| {
            if group.members.is_empty() {
                return Ok(None);
            }
            let members = || group.members.iter().map(|i| &question.members[*i]);
            let mean = |sum: f64| sum / group.members.len() as f64;
            Ok(Some(match self.options.hard_rule {
                HardRule::IntraGroupTrust => {
                    -mean(group.members.iter().map(|i| scorer.directed(&rows[*i], &group.sum)).sum())
                }
                HardRule::Capability => members()
                    .map(|m| m.needs.values().iter().zip(&scaled).map(|(n, w)| n * w).sum::<f64>())
                    .sum(),
                HardRule::MeanEnergy => {
                    mean(sum_of(members(), "the energy level", |m| question.level_of(m, ENERGY))?)
                }
                HardRule::MeanHp => mean(sum_of(members(), "the HP level", |m| question.level_of(m, HP))?),
            }))
        };
        groups.iter().map(value).collect()
    }
}

fn sum_of<'a>(
    members: impl Iterator<Item = &'a Member>,
    what: &'static str,
    level: impl Fn(&Member) -> Option<f64>,
) -> Result<f64, PolicyError> {
    members.map(|member| level(member).ok_or_else(|| missing("RNE", what, Some(member.id)))).sum()
}

/// The task of each group. From the hardest task on, each task goes to the best-suited remaining group that
/// may take it. Ties go to the group with the lowest id, and empty groups come last.
pub(super) fn tasks(
    question: &Question,
    groups: &[Group],
    values: &[Option<f64>],
    sizes: &Sizes,
) -> Vec<TaskId> {
    let mut tasks = vec![TaskId::default(); groups.len()];
    let mut left: Vec<usize> = (0..groups.len()).collect();
    for task in question.hardest_first() {
        let may = |group: &&usize| sizes.allows(&groups[**group], task);
        let mut candidates: Vec<usize> = left.iter().filter(may).copied().collect();
        if candidates.is_empty() {
            candidates.clone_from(&left);
        }
        let Some(best) = best_suited(&candidates, groups, values) else { break };
        tasks[best] = task;
        left.retain(|group| *group != best);
    }
    tasks
}

fn best_suited(candidates: &[usize], groups: &[Group], values: &[Option<f64>]) -> Option<usize> {
    let most = candidates.iter().filter_map(|group| values[*group]).reduce(f64::max);
    let Some(most) = most else { return candidates.first().copied() };
    // The comparison is written so that two infinite values are a tie.
    let is_worse = |value: f64| (most - value).abs() > TIE_TOLERANCE;
    let tied = candidates.iter().filter(|group| values[**group].is_some_and(|value| !is_worse(value)));
    tied.min_by_key(|group| groups[**group].members.iter().min()).copied()
}

/// The suitability of each group for the account, in the order of the tasks.
pub(super) fn account(tasks: &[TaskId], values: &[Option<f64>]) -> Vec<Suitability> {
    let of_group = |(task, value): (&TaskId, &Option<f64>)| Suitability {
        task: *task,
        value: value.filter(|value| value.is_finite()),
    };
    let mut all: Vec<Suitability> = tasks.iter().zip(values).map(of_group).collect();
    all.sort_by_key(|suitability| suitability.task);
    all
}
