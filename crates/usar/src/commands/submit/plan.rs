//! How a sweep is dealt out to a cluster.

use experiments::experiment::{Experiment, Shard};
use serde::{Deserialize, Serialize};

/// A shard takes ten minutes or more: what starting it costs is little then.
const LEAST_SECONDS: f64 = 600.0;
/// Shards that are made without being asked for.
const MOST_SHARDS: usize = 500;
/// Most shards that run at the same time without being asked for.
const MOST_AT_ONCE: u32 = 100;
/// The least time that is asked for, in minutes.
const LEAST_MINUTES: u64 = 30;

/// How a sweep is dealt out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Plan {
    /// Trials of each shard.
    pub trials: Vec<usize>,
    /// Most shards that run at the same time.
    pub at_once: u32,
    /// Threads of each.
    pub cpus: u32,
    /// Time of a trial on one thread, in seconds, as it was estimated.
    pub seconds_per_trial: f64,
}

/// What the user, or the site, wants of it.
pub(super) struct Wishes {
    pub shards: Option<u32>,
    pub at_once: Option<u32>,
    pub cpus: u32,
    /// The most tasks of an array that the site takes.
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

    /// How many shards there are.
    pub(crate) fn shards(&self) -> usize {
        self.trials.len()
    }

    /// How long the longest takes, in seconds, as it was estimated.
    pub(super) fn seconds(&self) -> f64 {
        let most = self.trials.iter().copied().max().unwrap_or(0);
        self.seconds_per_trial * most.div_ceil(self.cpus as usize) as f64
    }

    /// The time to ask for: twice what was estimated. A shard that needs longer is queued again and goes on.
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
        let experiment = Experiment::load(&paper, &overrides).unwrap();
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
