//! One file per verb of the command line.

pub(crate) mod calibrate;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod estimate;
pub(crate) mod explain;
pub(crate) mod group;
pub(crate) mod merge;
mod precision;
pub(crate) mod readings;
pub(crate) mod report;
pub(crate) mod reproduce;
pub(crate) mod run;
pub(crate) mod schema;
mod snapshot;
pub(crate) mod sweep;
pub(crate) mod trust;
pub(crate) mod verify;

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressStyle};
use usar_sim::scenario::Scenario;

use crate::experiment::Shard;
use crate::failure::Failure;
use crate::run::{Limits, Run, TrialKey, run_all};
use crate::sweep::folder::Folder;

/// Version of the JSON that the commands print.
pub(crate) const SCHEMA_VERSION: u32 = 1;

/// Loads a scenario and its text, or says in full what is wrong with it.
pub(crate) fn load(path: &Path) -> Result<(Scenario, String), Failure> {
    Scenario::load(path).map_err(Failure::input)
}

/// Numbers separated by commas.
pub(crate) fn numbers(flag: &str, text: &str) -> Result<Vec<f64>, Failure> {
    let number = |(i, part): (usize, &str)| {
        part.trim().parse::<f64>().map_err(|_| {
            Failure::input(format!("{flag}: entry {} must be a number, found {:?}", i + 1, part.trim()))
        })
    };
    text.split(',').enumerate().map(number).collect()
}

/// Set by Ctrl-C.
pub(crate) static STOP: AtomicBool = AtomicBool::new(false);

/// From now on, Ctrl-C sets [`STOP`].
pub(crate) fn stop_on_ctrl_c() {
    let _ = ctrlc::set_handler(|| STOP.store(true, Ordering::Relaxed));
}

/// One thread per core.
pub(crate) fn default_jobs() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Seeds of which trials are run at a time.
const SEEDS_AT_A_TIME: u32 = 8;

/// Runs the trials that a folder has not got yet.
pub(crate) fn run_missing(
    folder: &mut Folder,
    shard: Option<Shard>,
    limits: Limits,
    quiet: bool,
) -> Result<(), Failure> {
    let all: Vec<TrialKey> = folder.experiment().keys(shard).collect();
    let mut missing: Vec<TrialKey> = all.iter().filter(|key| !folder.has(key)).cloned().collect();
    // A few seeds at a time, so that a sweep that is broken off has whole pairs, and policies that decide alike share their trials; within these policy by
    // policy, so that no two threads simulate what they could share.
    missing.sort_by_key(|key| (key.case, key.trial / SEEDS_AT_A_TIME, key.policy, key.trial));
    if !quiet && missing.len() < all.len() {
        eprintln!("{} of {} trials are there already", all.len() - missing.len(), all.len());
    }
    if missing.is_empty() {
        return Ok(());
    }
    let progress = progress_bar(missing.len(), "trials", limits.jobs, quiet);
    let experiment = folder.shared_experiment();
    let run: Arc<Run> = Arc::new(move |key, halt| experiment.run(key, halt));
    let is_whole = run_all(missing, limits, run, &STOP, |outcome| {
        if let Some(failure) = outcome.failure() {
            progress.suspend(|| eprintln!("{failure}"));
        }
        progress.inc(1);
        folder.add(&outcome)
    })?;
    progress.finish_and_clear();
    folder.experiment().forget_shared();
    if is_whole { Ok(()) } else { Err(folder.interrupted()) }
}

/// Progress on stderr: a bar, or one line where that is not a terminal.
pub(crate) fn progress_bar(count: usize, of: &str, jobs: usize, quiet: bool) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(count as u64);
    let style = format!("{{bar:32}} {{pos}}/{{len}} {of}, {{elapsed}} gone, {{eta}} left {{msg}}");
    bar.set_style(ProgressStyle::with_template(&style).unwrap_or_else(|_| ProgressStyle::default_bar()));
    if bar.is_hidden() {
        let plural = if jobs == 1 { "" } else { "s" };
        eprintln!("{count} {of} on {jobs} thread{plural}");
    }
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    bar
}
