//! The cost of a sweep, measured on a few of its trials.

use std::collections::BTreeSet;
use std::time::Instant;

use experiments::Failure;
use experiments::experiment::{Experiment, Keep, Shard};
use experiments::run::{Outcome, Sessions, TrialKey};
use experiments::sweep::{Sizes, sizes};

use crate::arguments::progress_bar;
use crate::prelude::*;

/// Approximate number of measured trials, in whole seeds. Policies that decide alike share their trials, so
/// that only all policies of a seed show the true cost.
const TRIALS: usize = 24;

/// Multiples of this number modulo 1 spread over the sweep without a period that could coincide with the
/// grid of cases.
const GOLDEN_RATIO: f64 = 0.618_033_988_749_895;

/// A few trials of a sweep, and their times.
pub(crate) struct Measured {
    outcomes: Vec<Outcome>,
    /// Mean time of a trial on one thread, in seconds.
    pub seconds_each: f64,
    /// Number of trials that were simulated instead of taken over from a policy that decides alike.
    pub simulated: usize,
}

impl Measured {
    /// Runs all policies on a few cases and seeds, spread over the whole sweep.
    ///
    /// # Errors
    /// The run was interrupted.
    pub(crate) fn of(experiment: &Experiment, quiet: bool) -> Result<Self, Failure> {
        let sample = sample(experiment);
        let bar = progress_bar(sample.len(), "trials to measure", 1, quiet);
        let (start, mut sessions) = (Instant::now(), Sessions::default());
        let mut outcomes = Vec::new();
        for key in sample {
            let result = experiment.run(&key, &mut sessions, &STOP);
            if is_stopped() {
                return Err(Failure::Interrupted("stopped; nothing was written".to_owned()));
            }
            outcomes.push(Outcome { key, result });
            bar.inc(1);
        }
        let seconds_each = start.elapsed().as_secs_f64() / outcomes.len() as f64;
        bar.finish_and_clear();
        Ok(Self { outcomes, seconds_each, simulated: experiment.simulated() })
    }

    /// Number of measured trials.
    pub(crate) fn count(&self) -> usize {
        self.outcomes.len()
    }

    /// The disk space of this many trials, by themselves or as a shard, if `keep` is kept of each.
    ///
    /// # Errors
    /// There is no room for the files of the measured trials.
    pub(crate) fn sizes(
        &self,
        experiment: &Experiment,
        keep: Keep,
        shard: Option<Shard>,
        trials: usize,
    ) -> Result<Sizes, Failure> {
        let Sizes { finished, journal } = sizes(experiment, keep, shard, &self.outcomes, &STOP)?;
        let all = |bytes: u64| (bytes as f64 / self.count() as f64 * trials as f64).round() as u64;
        Ok(Sizes { finished: all(finished), journal: all(journal) })
    }
}

/// All policies on a few cases and seeds, spread over the whole sweep.
fn sample(experiment: &Experiment) -> Vec<TrialKey> {
    let (policies, trials) = (experiment.policies.len(), experiment.trials as usize);
    let count = experiment.cases.len() * trials;
    let wanted = (TRIALS / policies).clamp(1, count);
    let chosen = (0..wanted).map(|i| ((0.5 + i as f64 * GOLDEN_RATIO).fract() * count as f64) as usize);
    let chosen: BTreeSet<usize> = chosen.collect();
    let place = |index: usize| (index / trials, (index % trials + 1) as u32);
    chosen
        .into_iter()
        .map(place)
        .flat_map(|(case, trial)| (0..policies).map(move |policy| experiment.key((case, policy, trial))))
        .collect()
}
