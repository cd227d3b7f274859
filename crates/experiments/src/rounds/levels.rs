//! Levels of the groups, round by round.

use std::collections::BTreeMap;

use super::{Round, energy, hp};

/// Mean levels of the groups of one policy in one round.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupLevels {
    /// Name of the policy.
    pub policy: String,
    /// Number of the round, from 1.
    pub round: u32,
    /// Number of rounds over which the means are taken: those in which each task's group had members.
    pub count: usize,
    /// Mean energy and HP of each task's group, in the order of the table of tasks.
    pub groups: Vec<[f64; 2]>,
}

/// The mean levels of one policy for each round number, over the rounds in which each task's group had
/// members.
pub fn levels(label: &str, rounds: &[Round]) -> Vec<GroupLevels> {
    let mut by_round: BTreeMap<u32, Vec<Vec<[f64; 2]>>> = BTreeMap::new();
    for round in rounds {
        let groups = round.question.task_ids().map(|task| mean_levels(round, task));
        if let Some(groups) = groups.collect::<Option<Vec<[f64; 2]>>>() {
            by_round.entry(round.question.round).or_default().push(groups);
        }
    }
    let of_round = |(round, trials): (u32, Vec<Vec<[f64; 2]>>)| {
        let mean = |task: usize, level: usize| {
            trials.iter().map(|trial| trial[task][level]).sum::<f64>() / trials.len() as f64
        };
        GroupLevels {
            policy: label.to_owned(),
            round,
            count: trials.len(),
            groups: (0..trials[0].len()).map(|task| [mean(task, 0), mean(task, 1)]).collect(),
        }
    };
    by_round.into_iter().map(of_round).collect()
}

/// Mean energy and HP of a task's group; `None` if the group is empty.
pub fn mean_levels(round: &Round, task: teaming::TaskId) -> Option<[f64; 2]> {
    let members: Vec<_> = round.group(task).collect();
    let mean = |value: fn(&teaming::Member) -> f64| {
        members.iter().map(|member| value(member)).sum::<f64>() / members.len() as f64
    };
    (!members.is_empty()).then(|| [mean(energy), mean(hp)])
}
