//! Shared parts of commands that run for a while: threads, progress on stderr, and interruption.

use std::fmt::Display;
use std::io::Write;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock};
use std::time::{Duration, Instant};

use experiments::Failure;
use experiments::experiment::{PolicySpec, Shard};
use experiments::run::Limits;
use experiments::sweep::folder::Folder;
use experiments::sweep::host::{HostRun, Hosts};
use experiments::sweep::{missing, run_trials};
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use rne_core::{PolicyError, Session, TrialStart};
use signal_hook::consts::{SIGINT, SIGTERM};
use usar_sim::scenario::Scenario;
use usar_sim::simulation::Simulation;

use crate::printable::{counted, printable};

/// A trial checks once in this many steps whether it is to stop.
const CLOCK_CHECK_STEPS: u64 = 64;

/// Set by Ctrl-C, SIGTERM and SIGHUP.
pub(crate) static STOP: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// The number of the signal that set [`STOP`]; 0 for none.
static SIGNAL: LazyLock<Arc<AtomicUsize>> = LazyLock::new(Arc::default);

/// Opens a session of a policy for a trial.
pub(crate) fn session_of(
    spec: &PolicySpec,
    scenario: &Scenario,
    seed: u64,
) -> Result<Box<dyn Session>, Failure> {
    let failed = |error: PolicyError| Failure::run(format!("policy {}: {error}", spec.label));
    let mut session = spec.made().open().map_err(failed)?;
    session.reset(&TrialStart { scenario: &scenario.name, seed }).map_err(failed)?;
    Ok(session)
}

/// From now on, Ctrl-C, SIGTERM and SIGHUP set [`STOP`], and running work ends in an orderly way.
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

/// The exit status after a signal, in the convention of shells: 130 after Ctrl-C.
pub(crate) fn status_of_signal() -> u8 {
    match SIGNAL.load(Ordering::Relaxed) {
        0 => 130,
        signal => 128_u8.wrapping_add(signal as u8),
    }
}

/// Ends a single trial that exceeds its time limit or is to stop.
pub(crate) struct Guard {
    begun: Instant,
    longest_s: f64,
}

impl Guard {
    /// A guard that gives a trial this long from now on, in seconds of wall-clock time.
    pub(crate) fn new(longest_s: f64) -> Self {
        Self { begun: Instant::now(), longest_s }
    }

    /// Checks from time to time whether the trial may continue.
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
                "the trial took longer than {} s and had come to {at:.0} s of simulated time; --max-trial-s \
                 gives it longer",
                self.longest_s
            )));
        }
        Ok(())
    }
}

/// Prints a line on stderr. Failures to write it are ignored.
pub(crate) fn tell(what: impl Display) {
    let _ = writeln!(std::io::stderr(), "{}", printable(&what.to_string()));
}

/// One thread per core.
pub(crate) fn default_jobs() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Runs the trials that a folder lacks, with progress on stderr.
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
    let (mut host, begun) = (HostRun::of_part(folder.manifest().part(), limits.jobs), Instant::now());
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

/// Seconds between two progress lines if stderr is not a terminal.
const REPORT_S: u64 = 60;

/// Prints the progress once a minute until the bar is finished, for logs.
fn report_progress(bar: &ProgressBar, of: &str) {
    let (bar, of) = (bar.downgrade(), of.to_owned());
    std::thread::spawn(move || {
        for second in 1_u64.. {
            std::thread::sleep(Duration::from_secs(1));
            let Some(bar) = bar.upgrade().filter(|bar| !bar.is_finished()) else { return };
            if second.is_multiple_of(REPORT_S) {
                let (done, all) = (bar.position(), bar.length().unwrap_or(0));
                let gone = bar.elapsed();
                // The bar's own estimate forgets the beginning, and a trial may take minutes.
                let left = if done == 0 {
                    String::new()
                } else {
                    let left = gone.mul_f64((all - done) as f64 / done as f64);
                    format!("; {} left at this pace", HumanDuration(left))
                };
                tell(format_args!("{done} of {all} {of} after {}{left}", HumanDuration(gone)));
            }
        }
    });
}

/// Progress on stderr: a bar, or a line each minute if stderr is not a terminal.
pub(crate) fn progress_bar(count: usize, of: &str, jobs: usize, quiet: bool) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(count as u64);
    let style = format!("{{bar:32}} {{pos}}/{{len}} {of}, {{elapsed}} gone, {{eta}} left {{msg}}");
    bar.set_style(ProgressStyle::with_template(&style).unwrap_or_else(|_| ProgressStyle::default_bar()));
    if bar.is_hidden() {
        tell(format_args!("{count} {of} on {}", counted(jobs, "thread")));
        report_progress(&bar, of);
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
