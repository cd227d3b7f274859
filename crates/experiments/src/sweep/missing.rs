//! The trials that a folder has not got yet: which they are, and running them.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::folder::Folder;
use crate::experiment::Shard;
use crate::failure::Failure;
use crate::run::{Limits, Outcome, Run, TrialKey, run_all};

/// Seeds of which trials are run at a time.
const SEEDS_AT_A_TIME: u32 = 8;

/// The trials of a shard, or of the whole sweep, that a folder has not got yet, in the order in which they
/// are run.
#[must_use]
pub fn missing(folder: &Folder, shard: Option<Shard>) -> Vec<TrialKey> {
    let mut missing: Vec<TrialKey> = folder.experiment().keys(shard).filter(|key| !folder.has(key)).collect();
    // A few seeds at a time, so that a sweep that is broken off has whole pairs, and policies that decide
    // alike share their trials; within these policy by policy, so that no two threads simulate what they
    // could share.
    missing.sort_by_key(|key| (key.case, key.trial / SEEDS_AT_A_TIME, key.policy, key.trial));
    missing
}

/// Runs trials of a folder's sweep; each is on disk before `done` hears of it.
///
/// # Errors
/// The disk does not take a trial, no thread can be started, or `stop` was set before all were done.
pub fn run_trials(
    folder: &mut Folder,
    trials: Vec<TrialKey>,
    limits: Limits,
    stop: &AtomicBool,
    mut done: impl FnMut(&Outcome),
) -> Result<(), Failure> {
    let experiment = folder.shared_experiment();
    let run: Arc<Run> = Arc::new(move |key, halt| experiment.run(key, halt));
    let is_whole = run_all(trials, limits, run, stop, |outcome| {
        folder.add(&outcome)?;
        done(&outcome);
        Ok(())
    })?;
    folder.experiment().forget_shared();
    if is_whole { Ok(()) } else { Err(folder.interrupted()) }
}
