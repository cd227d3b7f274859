//! What commands that take a while have in common: threads, progress on stderr, and being stopped.

use std::fmt::Display;
use std::io::Write;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock};
use std::time::{Duration, Instant};

use experiments::Failure;
use experiments::experiment::Shard;
use experiments::run::Limits;
use experiments::sweep::folder::Folder;
use experiments::sweep::host::{HostRun, Hosts};
use experiments::sweep::{missing, run_trials};
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use signal_hook::consts::{SIGINT, SIGTERM};
use usar_sim::simulation::Simulation;

use crate::printable::printable;

/// A trial looks once in this many steps whether it is to stop.
const CLOCK_CHECK_STEPS: u64 = 64;

/// Set by Ctrl-C, SIGTERM and SIGHUP.
pub(crate) static STOP: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// The number of the signal that set [`STOP`]; 0 for none.
static SIGNAL: LazyLock<Arc<AtomicUsize>> = LazyLock::new(Arc::default);

/// From now on, Ctrl-C, SIGTERM and SIGHUP set [`STOP`]: what runs ends in order.
pub(crate) fn stop_on_signals() {
    #[cfg(unix)]
    let signals = [SIGINT, SIGTERM, signal_hook::consts::SIGHUP];
    #[cfg(not(unix))]
    let signals = [SIGINT, SIGTERM];
    for signal in signals {
        let _ = signal_hook::flag::register_usize(signal, Arc::clone(&SIGNAL), signal as usize);
        let _ = signal_hook::flag::register(signal, Arc::clone(&STOP));
    }
}

/// The exit status of what a signal ended, as a shell tells it: 130 after Ctrl-C.
pub(crate) fn status_of_signal() -> u8 {
    match SIGNAL.load(Ordering::Relaxed) {
        0 => 130,
        signal => 128_u8.wrapping_add(signal as u8),
    }
}

/// Ends a single trial that takes too long, or that is to stop.
pub(crate) struct Guard {
    begun: Instant,
    longest_s: f64,
}

impl Guard {
    /// From now on, a trial may take this long, in seconds of this machine.
    pub(crate) fn new(longest_s: f64) -> Self {
        Self { begun: Instant::now(), longest_s }
    }

    /// Looks once in a while whether the trial may go on.
    pub(crate) fn look(&self, simulation: &Simulation) -> Result<(), Failure> {
        if !simulation.steps().is_multiple_of(CLOCK_CHECK_STEPS) {
            return Ok(());
        }
        let at = simulation.time_s();
        if STOP.load(Ordering::Relaxed) {
            return Err(Failure::Interrupted(format!("stopped at {at:.0} s of simulated time")));
        }
        if self.begun.elapsed().as_secs_f64() > self.longest_s {
            return Err(Failure::run(format!(
                "the trial took longer than {} s and had come to {at:.0} s of simulated time; --max-trial-s gives it longer",
                self.longest_s
            )));
        }
        Ok(())
    }
}

/// Says something on stderr, in a line. Nothing depends on whether somebody can read it.
pub(crate) fn tell(what: impl Display) {
    let _ = writeln!(std::io::stderr(), "{}", printable(&what.to_string()));
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
    let (all, missing) = (folder.experiment().count(shard), missing(folder, shard));
    if !quiet && missing.len() < all {
        tell(format_args!("{} of {all} trials are there already", all - missing.len()));
    }
    if missing.is_empty() {
        return Ok(());
    }
    let progress = progress_bar(missing.len(), "trials", limits.jobs, quiet);
    let (mut host, begun) = (HostRun::new(folder, limits.jobs), Instant::now());
    let ran = run_trials(folder, missing, limits, &STOP, |outcome| {
        if let Some(failure) = outcome.failure() {
            progress.suspend(|| tell(failure));
        }
        host.trials += 1;
        progress.inc(1);
    });
    progress.finish_and_clear();
    host.seconds = begun.elapsed().as_secs_f64();
    if host.trials > 0 {
        Hosts::add(folder.path(), [host])?;
    }
    ran
}

/// Seconds between two lines about progress where stderr is not a terminal.
const REPORT_S: u64 = 60;

/// Says once a minute how far it is, until the bar is finished: for logs.
fn report_progress(bar: &ProgressBar, of: &str) {
    let (bar, of) = (bar.downgrade(), of.to_owned());
    std::thread::spawn(move || {
        for second in 1_u64.. {
            std::thread::sleep(Duration::from_secs(1));
            let Some(bar) = bar.upgrade().filter(|bar| !bar.is_finished()) else { return };
            if second.is_multiple_of(REPORT_S) {
                let (done, all) = (bar.position(), bar.length().unwrap_or(0));
                let (gone, left) = (HumanDuration(bar.elapsed()), HumanDuration(bar.eta()));
                tell(format_args!("{done} of {all} {of} after {gone}; {left} left at this pace"));
            }
        }
    });
}

/// Progress on stderr: a bar, or a line a minute where that is not a terminal.
pub(crate) fn progress_bar(count: usize, of: &str, jobs: usize, quiet: bool) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(count as u64);
    let style = format!("{{bar:32}} {{pos}}/{{len}} {of}, {{elapsed}} gone, {{eta}} left {{msg}}");
    bar.set_style(ProgressStyle::with_template(&style).unwrap_or_else(|_| ProgressStyle::default_bar()));
    if bar.is_hidden() {
        let plural = if jobs == 1 { "" } else { "s" };
        tell(format_args!("{count} {of} on {jobs} thread{plural}"));
        report_progress(&bar, of);
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
