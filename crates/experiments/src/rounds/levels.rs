//! Levels of the groups, round by round.

use std::collections::BTreeMap;

use rne_core::Difficulty;

use super::Round;
use crate::sweep::Grouped;

/// Mean levels of the groups of one policy in one round.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupLevels {
    /// Name of the policy.
    pub policy: String,
    /// Number of the round, from 1.
    pub round: u32,
    /// Rounds with two groups that it is over.
    pub count: usize,
    /// Mean energy and HP of the group of the hard task.
    pub hard: [f64; 2],
    /// And of the easy task.
    pub easy: [f64; 2],
}

/// Of all rounds of one policy, the means for each round that has two groups.
#[must_use]
pub fn levels(label: &str, rounds: &[Round]) -> Vec<GroupLevels> {
    let mut by_round: BTreeMap<u32, Vec<[[f64; 2]; 2]>> = BTreeMap::new();
    for round in rounds {
        let of_task = |task: Difficulty| {
            let members: Vec<_> = round.robots.iter().filter(|robot| robot.task == task).collect();
            let mean = |value: fn(&Grouped) -> f64| {
                members.iter().map(|robot| value(robot)).sum::<f64>() / members.len() as f64
            };
            (!members.is_empty()).then(|| [mean(|robot| robot.energy), mean(|robot| robot.hp)])
        };
        if let Some(both) = of_task(Difficulty::Hard).zip(of_task(Difficulty::Easy)) {
            by_round.entry(round.round).or_default().push([both.0, both.1]);
        }
    }
    let of_round = |(round, trials): (u32, Vec<[[f64; 2]; 2]>)| {
        let mean = |task: usize, level: usize| {
            trials.iter().map(|trial| trial[task][level]).sum::<f64>() / trials.len() as f64
        };
        GroupLevels {
            policy: label.to_owned(),
            round,
            count: trials.len(),
            hard: [mean(0, 0), mean(0, 1)],
            easy: [mean(1, 0), mean(1, 1)],
        }
    };
    by_round.into_iter().map(of_round).collect()
}
