//! `usar estimate`: what a sweep would take, from a short calibration run.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

use clap::Args;
use experiments::Failure;
use experiments::experiment::{Experiment, Overrides, split_list};
use experiments::run::{Outcome, TrialKey};
use experiments::sweep::folder::{Folder, Opening};
use serde::Serialize;

use super::SCHEMA_VERSION;
use crate::running::{STOP, default_jobs, progress_bar, stop_on_signals};

/// About how many trials are measured, in whole seeds: policies that decide alike share theirs, so that only all policies of a seed show what it takes.
const TRIALS: usize = 24;

/// Places that this is added to, again and again, are spread without a pattern that a grid of cases could have as well.
const GOLDEN_RATIO: f64 = 0.618_033_988_749_895;

/// How many trials, how long, and how much disk a sweep takes, from a short calibration run
#[derive(Debug, Args)]
#[command(after_help = "\
Runs all policies on one or a few seeds of one or a few of the sweep's cases (about 24 trials, or all policies once), and throws the trials away.

Examples:
  usar estimate scenarios/paper.ron --trials 1000
  usar estimate scenarios/sweeps/energy.ron --json")]
pub(crate) struct Arguments {
    /// Scenario or sweep file (RON)
    file: PathBuf,
    /// Policies, separated by commas [default: the file's]
    #[arg(long)]
    policies: Option<String>,
    /// Trials for each policy and case [default: the file's]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    trials: Option<u32>,
    /// Set a field of the scenario, by its path, to a value in RON; may stand several times
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Threads that the sweep will have [default: one per core]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1024))]
    jobs: Option<u32>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Output {
    schema_version: u32,
    cases: usize,
    policies: usize,
    trials_each: u32,
    trials: usize,
    jobs: usize,
    seconds_per_trial: f64,
    seconds: f64,
    bytes: u64,
    measured: usize,
    simulated: usize,
}

impl Arguments {
    pub(crate) fn execute(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let overrides = Overrides {
            policies: self
                .policies
                .as_deref()
                .map(|list| split_list(list).into_iter().map(str::to_owned).collect()),
            trials: self.trials,
            set: self.set.clone(),
            ..Overrides::default()
        };
        let experiment = Experiment::load(&self.file, &overrides)?;
        let sample = sample(&experiment);
        let trials = experiment.cases.len() * experiment.policies.len() * experiment.trials as usize;
        let experiment = Arc::new(experiment);
        let (seconds_each, bytes_each) = measure(&experiment, &sample)?;
        let jobs = self.jobs.map_or_else(default_jobs, |jobs| jobs as usize);
        let output = Output {
            schema_version: SCHEMA_VERSION,
            cases: experiment.cases.len(),
            policies: experiment.policies.len(),
            trials_each: experiment.trials,
            trials,
            jobs,
            seconds_per_trial: seconds_each,
            seconds: seconds_each * trials.div_ceil(jobs) as f64,
            bytes: bytes_each * trials as u64,
            measured: sample.len(),
            simulated: experiment.simulated(),
        };
        if self.json {
            return Ok(writeln!(out, "{}", serde_json::to_string(&output).map_err(Failure::run)?)?);
        }
        let Output { cases, policies, trials_each, trials, seconds, bytes, measured, simulated, .. } = output;
        writeln!(out, "trials  {trials}: {cases} cases x {policies} policies x {trials_each}")?;
        writeln!(out, "time    about {} on {jobs} threads ({seconds_each:.2} s a trial)", duration(seconds))?;
        writeln!(out, "disk    about {}", size(bytes))?;
        writeln!(
            out,
            "from {measured} trials, of which policies that decide alike shared {}; times depend on what else the machine does",
            measured - simulated
        )?;
        Ok(())
    }
}

/// All policies on a few of the cases and seeds, spread over all.
fn sample(experiment: &Experiment) -> Vec<TrialKey> {
    let (policies, trials) = (experiment.policies.len(), experiment.trials as usize);
    let count = experiment.cases.len() * trials;
    let wanted = (TRIALS / policies).clamp(1, count);
    let chosen = (0..wanted).map(|i| ((0.5 + i as f64 * GOLDEN_RATIO).fract() * count as f64) as usize);
    let chosen: BTreeSet<usize> = chosen.collect();
    let place = |index: usize| (index / trials, (index % trials + 1) as u32);
    chosen
        .into_iter()
        .map(place)
        .flat_map(|(case, trial)| (0..policies).map(move |policy| experiment.key((case, policy, trial))))
        .collect()
}

/// Mean time in seconds and size in bytes of these trials.
fn measure(experiment: &Arc<Experiment>, sample: &[TrialKey]) -> Result<(f64, u64), Failure> {
    stop_on_signals();
    let stopped = || Failure::Interrupted("stopped; nothing was written".to_owned());
    let place = tempfile::tempdir()?;
    let path = place.path().join("sweep");
    let mut folder = Folder::open(&path, Arc::clone(experiment), Opening::default(), &mut |_| {})?;
    let bar = progress_bar(sample.len(), "trials to measure", 1, false);
    let start = Instant::now();
    for key in sample {
        let result = experiment.run(key, &STOP);
        if STOP.load(Ordering::Relaxed) {
            return Err(stopped());
        }
        folder.add(&Outcome { key: key.clone(), result })?;
        bar.inc(1);
    }
    let seconds = start.elapsed().as_secs_f64() / sample.len() as f64;
    bar.finish_and_clear();
    folder.finish(&STOP).map_err(|failure| match failure {
        Failure::Interrupted(_) => stopped(),
        other => other,
    })?;
    let files = std::fs::read_dir(&path)?.flatten().filter_map(|entry| entry.metadata().ok());
    Ok((seconds, files.map(|file| file.len()).sum::<u64>() / sample.len() as u64))
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("{s:.0} s"),
        s if s < 6_000.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3_600.0),
    }
}

fn size(bytes: u64) -> String {
    match bytes as f64 {
        b if b < 1e6 => format!("{:.0} kB", b / 1e3),
        b if b < 1e9 => format!("{:.1} MB", b / 1e6),
        b => format!("{:.1} GB", b / 1e9),
    }
}
