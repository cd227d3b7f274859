//! One file per verb of the command line.

pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod estimate;
pub(crate) mod group;
pub(crate) mod merge;
mod precision;
pub(crate) mod report;
pub(crate) mod run;
mod snapshot;
pub(crate) mod sweep;
pub(crate) mod trust;
pub(crate) mod verify;

use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};
use usar_sim::scenario::Scenario;

use crate::failure::Failure;

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

/// One thread per core.
pub(crate) fn default_jobs() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Progress on stderr: a bar, or one line where that is not a terminal.
pub(crate) fn progress_bar(trials: usize, jobs: usize, quiet: bool) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(trials as u64);
    let style = "{bar:32} {pos}/{len} trials, {elapsed} gone, {eta} left";
    bar.set_style(ProgressStyle::with_template(style).unwrap_or_else(|_| ProgressStyle::default_bar()));
    if bar.is_hidden() {
        eprintln!("{trials} trials on {jobs} threads");
    }
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    bar
}
