//! The distribution of a sweep over a cluster.

use experiments::experiment::{Experiment, Shard};
use serde::{Deserialize, Serialize};

/// Least estimated time of a shard, in seconds. The cost of starting a shard is then small.
const LEAST_SECONDS: f64 = 600.0;
/// Default limit of the number of shards.
const MOST_SHARDS: usize = 500;
/// Default limit of the number of shards that run at the same time.
const MOST_AT_ONCE: u32 = 100;
/// Least time limit of a job, in minutes.
const LEAST_MINUTES: u64 = 30;

/// The distribution of a sweep over shards.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Plan {
    /// Number of trials of each shard.
    pub trials: Vec<usize>,
    /// Largest number of shards that run at the same time.
    pub at_once: u32,
    /// Number of threads of each shard.
    pub cpus: u32,
    /// Estimated time of a trial on one thread, in seconds.
    pub seconds_per_trial: f64,
}

/// The user's and the site's requirements.
pub(super) struct Wishes {
    pub shards: Option<u32>,
    pub at_once: Option<u32>,
    pub cpus: u32,
    /// Largest number of tasks in an array that the site accepts.
    pub most_tasks: usize,
}

impl Plan {
    pub(super) fn of(experiment: &Experiment, seconds_per_trial: f64, wishes: &Wishes) -> Self {
        let seconds = seconds_per_trial * experiment.count(None) as f64 / f64::from(wishes.cpus);
        let most = wishes.most_tasks.min(experiment.seeds_of_cases()).max(1);
        let shards = match wishes.shards {
            Some(shards) => (shards as usize).min(most),
            None => ((seconds / LEAST_SECONDS) as usize).clamp(1, most.min(MOST_SHARDS)),
        } as u32;
        let count = |number| experiment.count(Some(Shard { number, of: shards }));
        let at_once = wishes.at_once.unwrap_or(MOST_AT_ONCE).min(shards);
        let trials = (1..=shards).map(count).collect();
        Self { trials, at_once, cpus: wishes.cpus, seconds_per_trial }
    }

    /// Number of shards.
    pub(crate) fn shards(&self) -> usize {
        self.trials.len()
    }

    /// Estimated time of the longest shard, in seconds.
    pub(super) fn seconds(&self) -> f64 {
        let most = self.trials.iter().copied().max().unwrap_or(0);
        self.seconds_per_trial * most.div_ceil(self.cpus as usize) as f64
    }

    /// The time limit to request: twice the estimate. A shard that needs longer is queued again and
    /// resumes.
    pub(super) fn time(&self) -> String {
        let minutes = ((self.seconds() / 30.0).ceil() as u64).max(LEAST_MINUTES);
        format!("{:02}:{:02}:00", minutes / 60, minutes % 60)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use experiments::experiment::Overrides;

    use super::*;

    #[test]
    fn shards_take_ten_minutes_or_more_and_are_as_many_as_the_site_takes() {
        let paper = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/paper.ron");
        let overrides = Overrides { trials: Some(1000), ..Overrides::default() };
        let experiment = Experiment::load(&paper, &overrides, &policies::standard()).unwrap();
        let trials = experiment.count(None) as f64;
        let shards = |hours: f64, shards, most_tasks| {
            let wishes = Wishes { shards, at_once: None, cpus: 4, most_tasks };
            let plan = Plan::of(&experiment, hours * 3600.0 / trials, &wishes);
            assert_eq!(plan.trials.iter().sum::<usize>(), experiment.count(None));
            (plan.shards(), plan.at_once, plan.time())
        };
        assert_eq!(shards(0.1, None, 1000), (1, 1, "00:30:00".to_owned()));
        assert_eq!(shards(80.0, None, 1000), (120, 100, "00:30:00".to_owned()));
        assert_eq!(
            shards(80.0, Some(10), 1000).2,
            "04:00:00",
            "100 seeds of 4 trials of 72 s on 4 processors, twice"
        );
        assert_eq!(shards(8000.0, None, 1000).0, 500);
        assert_eq!(shards(8000.0, None, 50).0, 50);
        assert_eq!(shards(0.1, Some(7), 1000).0, 7);
        assert_eq!(shards(0.1, Some(7000), 10_000).0, 1000, "one for each seed");
    }
}
