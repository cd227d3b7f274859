//! Threads of commands that run for a while, and their progress on stderr.

use std::fmt::Display;
use std::sync::Arc;
use std::time::{Duration, Instant};

use experiments::experiment::{Experiment, Shard};
use experiments::run::Limits;
use experiments::sweep::folder::{Folder, Opening};
use experiments::sweep::host::{HostRun, Hosts};
use experiments::sweep::{missing, run_trials};
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use super::count;
use crate::prelude::*;

/// Threads and progress.
#[derive(Debug, Args)]
pub struct ProgressArguments {
    /// Threads [default: one per core]
    #[arg(long, value_parser = count(1..=1024))]
    jobs: Option<u32>,
    /// No progress on stderr
    #[arg(long)]
    pub quiet: bool,
}

impl ProgressArguments {
    /// The number of threads.
    pub fn jobs(&self) -> usize {
        self.jobs.map_or_else(default_jobs, |jobs| jobs as usize)
    }

    /// The limits of a run, with the longest time of a trial.
    pub fn limits(&self, trial: Option<Duration>) -> Limits {
        Limits { jobs: self.jobs(), trial }
    }

    /// Prints a line on stderr, unless the command is to be quiet.
    pub fn tell(&self, what: impl Display) {
        if !self.quiet {
            tell(what);
        }
    }

    /// Tells how much an earlier run has left, if it has left anything.
    pub fn tell_resumed(&self, there: usize, what: &str) {
        if there > 0 {
            self.tell(format_args!("{there} {what} are there already"));
        }
    }

    /// A bar for work that goes on until it is done or a signal stops it.
    pub fn bar(&self, count: usize, of: &str) -> ProgressBar {
        stop_on_signals();
        progress_bar(count, of, self.jobs(), self.quiet)
    }

    /// Works on the threads of the command, with a bar.
    ///
    /// # Errors
    /// The system gives no threads.
    pub fn work<T: Send>(
        &self,
        count: usize,
        of: &str,
        work: impl FnOnce(&ProgressBar) -> T + Send,
    ) -> Result<T, Failure> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.jobs()).build().map_err(Failure::run)?;
        let bar = self.bar(count, of);
        let done = pool.install(|| work(&bar));
        bar.finish_and_clear();
        Ok(done)
    }

    /// Opens the folder of an experiment, runs the trials that it lacks and finishes it.
    ///
    /// # Errors
    /// Those of [`opened`] and of [`Self::run_missing`].
    pub fn finished(&self, place: &Path, experiment: Experiment) -> Result<Folder, Failure> {
        let mut folder = opened(place, experiment, Opening::default())?;
        self.run_missing(&mut folder, None, None)?;
        folder.finish(&STOP)?;
        Ok(folder)
    }

    /// Runs the trials that a folder lacks.
    ///
    /// # Errors
    /// A trial, a policy or the disk fails, or a signal stops the run.
    pub fn run_missing(
        &self,
        folder: &mut Folder,
        shard: Option<Shard>,
        trial: Option<Duration>,
    ) -> Result<(), Failure> {
        let (all, missing) = (folder.experiment().count(shard), missing(folder, shard));
        self.tell_resumed(all - missing.len(), &format!("of {all} trials"));
        if missing.is_empty() {
            return Ok(());
        }
        let limits = self.limits(trial);
        let bar = self.bar(missing.len(), "trials");
        let (mut host, begun) = (HostRun::of_part(folder.manifest().part(), limits.jobs), Instant::now());
        let ran = run_trials(folder, missing, limits, &STOP, |outcome| {
            if let Some(failure) = outcome.failure() {
                bar.suspend(|| tell(failure));
            }
            host.trials += 1;
            bar.inc(1);
        });
        bar.finish_and_clear();
        host.seconds = begun.elapsed().as_secs_f64();
        if host.trials > 0 {
            Hosts::add(folder.path(), [host])?;
        }
        ran
    }
}

/// Opens the folder of an experiment; what there is to note is told on stderr.
///
/// # Errors
/// The folder has other results, or the disk does not take it.
pub fn opened(place: &Path, experiment: Experiment, opening: Opening) -> Result<Folder, Failure> {
    Folder::open(place, Arc::new(experiment), opening, &mut |note| tell(format_args!("note: {note}")))
}

/// One thread per core.
pub fn default_jobs() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
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
pub fn progress_bar(count: usize, of: &str, jobs: usize, quiet: bool) -> ProgressBar {
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
