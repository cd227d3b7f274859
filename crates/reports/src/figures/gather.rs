//! The data of figures beyond the metrics, from one pass over the trials of a case.

use std::collections::BTreeMap;

use experiments::Failure;
use experiments::rounds::{KEYS, SortingAgreement, mean_levels, rounds_of};
use experiments::run::{Trial, series_times};
use experiments::sweep::folder::Folder;
use teaming::Question;

/// The data gathered for one policy.
#[derive(Default)]
pub(super) struct Gathered {
    /// For each trial and time, the number of deliveries so far: in total, and from each task.
    pub delivered: Vec<Vec<Vec<f64>>>,
    /// For each round and robot, the number of trials in which it was grouped for each task.
    pub groups: BTreeMap<(u32, u32), Vec<u32>>,
    /// For each round, task and trial, the mean energy and HP of the group.
    pub levels: BTreeMap<(u32, usize), Vec<[f64; 2]>>,
    /// The first question of the trial that is shown.
    pub first_question: Option<Question>,
    /// Number of that trial.
    pub first_trial: u32,
    /// How similar its splits are to sorting.
    pub agreement: [SortingAgreement; 3],
    /// Roles of the robots.
    pub roles: Vec<String>,
}

/// Passes once over all trials of a case, policy by policy. The first question is that of the trial with this
/// seed, or of the first trial.
pub(super) fn gather(folder: &mut Folder, case: usize, seed: Option<u64>) -> Result<Vec<Gathered>, Failure> {
    let times: Vec<f64> = series_times(folder.experiment().cases[case].scenario.duration_s).collect();
    let policies = folder.experiment().policies.len();
    if !folder.experiment().keep.has_records() {
        return Ok((0..policies).map(|_| Gathered::default()).collect());
    }
    let mut all = Vec::new();
    for policy in 0..policies {
        let mut gathered = Gathered::default();
        for place in folder.places(case, policy) {
            if let Ok(trial) = folder.outcome(place)?.result {
                let is_shown = seed.is_none_or(|seed| folder.experiment().seed(place.2) == seed);
                gathered.add(place.2, &trial, &times, is_shown);
            }
        }
        all.push(gathered);
    }
    Ok(all)
}

impl Gathered {
    fn add(&mut self, number: u32, trial: &Trial, times: &[f64], is_shown: bool) {
        let point = |time: &f64| {
            let by_task = trial.delivered(*time);
            let total = by_task.iter().sum::<usize>();
            [total].into_iter().chain(by_task).map(|count| count as f64).collect()
        };
        self.delivered.push(times.iter().map(point).collect());
        self.roles = trial.record.robots.iter().map(|robot| robot.role.clone()).collect();
        for round in rounds_of(number, trial) {
            self.agreement.iter_mut().zip(&KEYS).for_each(|(agreement, key)| agreement.add(&round, key));
            for task in round.question.task_ids() {
                for member in round.group(task) {
                    let tasks = vec![0; round.question.tasks.len()];
                    let counts = self.groups.entry((round.question.round, member.id)).or_insert(tasks);
                    counts[task.index()] += 1;
                }
                if let Some(levels) = mean_levels(&round, task) {
                    self.levels.entry((round.question.round, task.index())).or_default().push(levels);
                }
            }
            if is_shown && self.first_question.is_none() {
                self.first_trial = number;
                self.first_question = Some(round.true_question());
            }
        }
    }
}
