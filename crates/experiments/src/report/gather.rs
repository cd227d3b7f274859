//! What figures need beyond the metrics, from one pass over the trials of a case.

use std::collections::BTreeMap;

use rne_core::Difficulty;

use crate::failure::Failure;
use crate::rounds::{KEYS, Likeness, rounds_of};
use crate::sweep::folder::Folder;
use crate::sweep::{Grouped, Trial, series_times};

/// What was gathered of one policy.
#[derive(Default)]
pub(super) struct Gathered {
    /// For each trial, what was delivered up to each time: total, hard, easy.
    pub delivered: Vec<Vec<[f64; 3]>>,
    /// For each round and robot, in how many trials it was grouped for the hard and for the easy task.
    pub groups: BTreeMap<(u32, u32), [u32; 2]>,
    /// For each round, task and trial, the mean energy and HP of the group.
    pub levels: BTreeMap<(u32, usize), Vec<[f64; 2]>>,
    /// The robots of the first round of the first trial that has one.
    pub first_round: Vec<Grouped>,
    /// Number of that trial.
    pub first_trial: u32,
    /// How like its splits are to sorting.
    pub likeness: [Likeness; 3],
    /// Roles of the robots.
    pub roles: Vec<&'static str>,
}

/// Goes once over all trials of a case, policy by policy.
pub(super) fn gather(folder: &mut Folder, case: usize) -> Result<Vec<Gathered>, Failure> {
    let times: Vec<f64> = series_times(folder.experiment().cases[case].scenario.duration_s).collect();
    let policies = folder.experiment().policies.len();
    let mut all = Vec::new();
    for policy in 0..policies {
        let mut gathered = Gathered::default();
        for place in folder.places(case, policy) {
            if let Ok(trial) = folder.outcome(place)?.result {
                gathered.add(place.2, &trial, &times);
            }
        }
        all.push(gathered);
    }
    Ok(all)
}

impl Gathered {
    fn add(&mut self, number: u32, trial: &Trial, times: &[f64]) {
        let point = |time: &f64| {
            let [hard, easy] = trial.delivered(*time).map(|count| count as f64);
            [hard + easy, hard, easy]
        };
        for round in rounds_of(number, trial) {
            self.likeness.iter_mut().zip(&KEYS).for_each(|(likeness, key)| likeness.add(&round, key));
        }
        self.delivered.push(times.iter().map(point).collect());
        let mut groups: BTreeMap<(u32, usize), Vec<[f64; 2]>> = BTreeMap::new();
        for robot in &trial.grouped {
            let task = usize::from(robot.task == Difficulty::Easy);
            self.groups.entry((robot.round, robot.robot)).or_default()[task] += 1;
            groups.entry((robot.round, task)).or_default().push([robot.energy, robot.hp]);
        }
        for (group, levels) in groups {
            let mean =
                |level: usize| levels.iter().map(|robot| robot[level]).sum::<f64>() / levels.len() as f64;
            self.levels.entry(group).or_default().push([mean(0), mean(1)]);
        }
        if self.first_round.is_empty() {
            self.first_trial = number;
            self.first_round = trial.grouped.iter().filter(|robot| robot.round == 1).cloned().collect();
            self.first_round.sort_by_key(|robot| robot.robot);
            self.roles = trial.record.robots.iter().map(|robot| robot.role.name()).collect();
        }
    }
}
