//! The trials that a folder lacks, and running them.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::folder::Folder;
use crate::experiment::{Place, Shard};
use crate::failure::Failure;
use crate::run::{Limits, Outcome, Run, run_batches};

/// Number of seeds whose trials are run together.
const SEEDS_AT_A_TIME: usize = 8;

/// The trials of a shard, or of the whole sweep, that a folder lacks, in the order in which they are run.
#[must_use]
pub fn missing(folder: &Folder, shard: Option<Shard>) -> Vec<Place> {
    let experiment = folder.experiment();
    let policies = experiment.policies.len();
    let mut missing = Vec::new();
    for case in 0..experiment.cases.len() {
        // A few seeds at a time, so that an interrupted sweep has whole pairs, and policies that decide
        // alike share their trials. Within these seeds policy by policy, so that no two threads simulate a
        // trial that they could share.
        let trials: Vec<u32> = experiment.trials_of(case, shard).collect();
        for some in trials.chunks(SEEDS_AT_A_TIME) {
            let places =
                (0..policies).flat_map(|policy| some.iter().map(move |trial| (case, policy, *trial)));
            missing.extend(places.filter(|place| !folder.results().contains_key(place)));
        }
    }
    missing
}

/// Runs trials of a folder's sweep. Each trial is on disk before `done` is called with it.
///
/// # Errors
/// The disk does not take a trial, no thread can be started, or `stop` was set before all trials were done.
pub fn run_trials(
    folder: &mut Folder,
    trials: Vec<Place>,
    limits: Limits,
    stop: &AtomicBool,
    mut done: impl FnMut(&Outcome),
) -> Result<(), Failure> {
    let (experiment, names) = (folder.shared_experiment(), folder.shared_experiment());
    let run: Arc<Run> = Arc::new(move |key, halt| experiment.run(key, halt));
    let keys = trials.into_iter().map(move |place| names.key(place));
    let is_whole = run_batches(keys, limits, run, stop, |outcomes| {
        folder.add(&outcomes)?;
        outcomes.iter().for_each(&mut done);
        Ok(())
    })?;
    folder.experiment().forget_shared();
    if is_whole { Ok(()) } else { Err(folder.interrupted()) }
}
