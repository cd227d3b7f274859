//! What commands that take a while have in common: threads, progress on stderr, and Ctrl-C.

use std::sync::atomic::{AtomicBool, Ordering};

use experiments::Failure;
use experiments::experiment::Shard;
use experiments::run::Limits;
use experiments::sweep::folder::Folder;
use experiments::sweep::{missing, run_trials};
use indicatif::{ProgressBar, ProgressStyle};

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

/// Runs the trials that a folder has not got yet, with progress on stderr.
pub(crate) fn run_missing(
    folder: &mut Folder,
    shard: Option<Shard>,
    limits: Limits,
    quiet: bool,
) -> Result<(), Failure> {
    let (all, missing) = (folder.experiment().keys(shard).count(), missing(folder, shard));
    if !quiet && missing.len() < all {
        eprintln!("{} of {all} trials are there already", all - missing.len());
    }
    if missing.is_empty() {
        return Ok(());
    }
    let progress = progress_bar(missing.len(), "trials", limits.jobs, quiet);
    let ran = run_trials(folder, missing, limits, &STOP, |outcome| {
        if let Some(failure) = outcome.failure() {
            progress.suspend(|| eprintln!("{failure}"));
        }
        progress.inc(1);
    });
    progress.finish_and_clear();
    ran
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
