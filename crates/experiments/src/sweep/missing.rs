//! The trials that a folder lacks, and running them.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use store::Failure;

use super::folder::Folder;
use crate::experiment::{Experiment, Place, Shard};
use crate::run::{Limits, Outcome, Run, run_batches};

/// Number of seeds whose trials are run together.
const SEEDS_AT_A_TIME: usize = 8;

/// The trials of a shard, or of the whole sweep, that a folder lacks, in the order in which they are run.
pub fn missing(folder: &Folder, shard: Option<Shard>) -> Vec<Place> {
    let experiment = folder.experiment();
    let cases: Vec<Vec<u32>> =
        (0..experiment.cases.len()).map(|case| experiment.trials_of(case, shard).collect()).collect();
    let most = cases.iter().map(Vec::len).max().unwrap_or(0);
    let mut missing = Vec::new();
    // A few seeds at a time, in every case: an interrupted sweep has whole pairs, and can be compared in all
    // cases. Within these seeds policy by policy: policies that decide alike share their trials, and no two
    // threads simulate a trial that they could share.
    for from in (0..most).step_by(SEEDS_AT_A_TIME) {
        for (case, trials) in cases.iter().enumerate() {
            let some = &trials[from.min(trials.len())..(from + SEEDS_AT_A_TIME).min(trials.len())];
            let policies = 0..experiment.policies.len();
            let places = policies.flat_map(|policy| some.iter().map(move |trial| (case, policy, *trial)));
            missing.extend(places.filter(|place| !folder.results().contains_key(place)));
        }
    }
    missing
}

/// Runs trials of a folder's sweep. Each trial is on disk before `done` is called with it.
///
/// # Errors
/// The disk does not take a trial, no thread can be started, a policy gave up, or `stop` was set before all
/// trials were done.
pub fn run_trials(
    folder: &mut Folder,
    trials: Vec<Place>,
    limits: Limits,
    stop: &AtomicBool,
    mut done: impl FnMut(&Outcome),
) -> Result<(), Failure> {
    let (experiment, names) = (folder.shared_experiment(), folder.shared_experiment());
    let run: Arc<Run> = Arc::new(move |key, sessions, halt| experiment.run(key, sessions, halt));
    let keys = trials.into_iter().map(move |place| names.key(place));
    let is_whole = run_batches(keys, limits, run, stop, |outcomes| {
        folder.add(&outcomes)?;
        outcomes.iter().for_each(&mut done);
        check_goes_on(folder.experiment(), &outcomes)
    })?;
    folder.experiment().forget_shared();
    if is_whole { Ok(()) } else { Err(folder.interrupted()) }
}

/// Refuses to go on when a policy will not answer any more.
fn check_goes_on(experiment: &Experiment, outcomes: &[Outcome]) -> Result<(), Failure> {
    for Outcome { key, .. } in outcomes.iter().filter(|outcome| outcome.result.is_err()) {
        if let Some(reason) = experiment.policies[key.policy].made().it.gave_up() {
            return Err(Failure::run(format!("the sweep ends here: policy {}: {reason}", key.label)));
        }
    }
    Ok(())
}
