//! Many trials: which ones, on which threads, and what became of them.

pub mod folder;
pub mod links;
mod rows;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;

use rayon::prelude::*;
use usar_sim::record::{Status, TrialRecord};
use usar_sim::scenario::Scenario;

use crate::cli::panic_message;
use crate::failure::Failure;

/// Names one trial of a sweep.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TrialKey {
    /// Place of the policy in the sweep's list.
    pub policy: usize,
    /// Name of the policy.
    pub policy_name: String,
    /// Number of the trial, from 1. Trials of the same number are pairs: they share their seed.
    pub trial: u32,
    /// Seed of the trial.
    pub seed: u64,
}

/// What became of a trial.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// Which trial.
    pub key: TrialKey,
    /// Its record, or why there is none.
    pub result: Result<TrialRecord, String>,
}

impl Outcome {
    /// The record, if the trial can be used.
    #[must_use]
    pub fn record(&self) -> Option<&TrialRecord> {
        self.result.as_ref().ok().filter(|record| !matches!(record.status, Status::Failed(_)))
    }

    /// Why the trial cannot be used, in one sentence.
    #[must_use]
    pub fn failure(&self) -> Option<String> {
        let (Ok(TrialRecord { status: Status::Failed(reason), .. }) | Err(reason)) = &self.result else {
            return None;
        };
        let TrialKey { policy_name, trial, seed, .. } = &self.key;
        Some(format!("trial {trial} of {policy_name} (seed {seed}) failed: {reason}"))
    }
}

/// All trials of a sweep, policy by policy.
#[must_use]
pub fn keys(scenario: &Scenario) -> Vec<TrialKey> {
    let policies = scenario.sweep.policies.iter().enumerate();
    let trials = |(policy, name): (usize, &String)| {
        let name = name.clone();
        (0..scenario.sweep.trials).map(move |i| TrialKey {
            policy,
            policy_name: name.clone(),
            trial: i + 1,
            seed: scenario.sweep.first_seed.wrapping_add(u64::from(i)),
        })
    };
    policies.flat_map(trials).collect()
}

/// Runs all trials on `jobs` threads and returns their outcomes in the order of the keys. A trial that panics is a failed trial; the
/// others go on. `done` hears of each outcome as it comes, in any order.
///
/// # Errors
/// The threads cannot be started.
pub fn run_all(
    keys: &[TrialKey],
    jobs: usize,
    run: impl Fn(&TrialKey) -> Result<TrialRecord, String> + Sync,
    done: impl Fn(&Outcome) + Sync + Send,
) -> Result<Vec<Outcome>, Failure> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(jobs)
        .build()
        .map_err(|error| Failure::run(format!("cannot start {jobs} threads: {error}")))?;
    let done = Mutex::new(done);
    let one = |key: &TrialKey| {
        let result = catch_unwind(AssertUnwindSafe(|| run(key)))
            .unwrap_or_else(|panic| Err(format!("internal error: {}", panic_message(&*panic))));
        let outcome = Outcome { key: key.clone(), result };
        if let Ok(done) = done.lock() {
            done(&outcome);
        }
        outcome
    };
    Ok(pool.install(|| keys.par_iter().with_max_len(1).map(one).collect()))
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    fn keys_for(trials: u32) -> Vec<TrialKey> {
        (0..trials)
            .map(|i| TrialKey { policy: 0, policy_name: "FAKE".into(), trial: i + 1, seed: u64::from(i) })
            .collect()
    }

    #[test]
    fn a_trial_that_panics_fails_alone_and_the_order_is_kept() {
        let heard = AtomicUsize::new(0);
        let run = |key: &TrialKey| -> Result<TrialRecord, String> {
            assert!(key.seed != 2, "seed two");
            Err(format!("fake {}", key.seed))
        };
        let outcomes = run_all(&keys_for(5), 2, run, |_| {
            heard.fetch_add(1, Ordering::Relaxed);
        })
        .unwrap();
        let reasons: Vec<String> = outcomes.iter().filter_map(Outcome::failure).collect();
        assert_eq!(heard.load(Ordering::Relaxed), 5);
        assert_eq!(reasons[1], "trial 2 of FAKE (seed 1) failed: fake 1");
        assert_eq!(reasons[2], "trial 3 of FAKE (seed 2) failed: internal error: seed two");
    }
}
