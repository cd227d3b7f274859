//! `usar cluster estimate`: the cost of a sweep, from a short calibration run.

mod measured;

use std::collections::BTreeMap;

use experiments::experiment::{Experiment, Keep, Shard};
use experiments::sweep::Sizes;
use serde::Serialize;

pub(crate) use measured::Measured;

use crate::arguments::{JsonArgument, ProgressArguments, Selection, count};
use crate::library;
use crate::prelude::*;

/// How long a sweep takes, and how much disk, from a few of its trials
#[derive(Debug, Args)]
#[command(after_help = "\
Runs all policies on one or a few seeds of one or a few of the sweep's cases (about 24 trials, or all \
policies once), and throws the trials away. The journal of a finished sweep is compressed; while it runs it \
is not, and takes the room that is told. --jobs says how many threads the sweep will have, --shards into how \
many shards it will be dealt: then time and disk of each are told as well.

Examples:
  usar cluster estimate scenarios/paper.ron --trials 1000
  usar cluster estimate scenarios/paper.ron --trials 100000 --keep trials
  usar cluster estimate scenarios/sweeps/energy.ron --shards 8 --jobs 4
  usar cluster estimate scenarios/sweeps/energy.ron --json")]
pub(crate) struct Arguments {
    /// Scenario or sweep file (RON)
    #[arg(value_parser = library::path)]
    file: PathBuf,
    #[command(flatten)]
    selection: Selection,
    #[command(flatten)]
    progress: ProgressArguments,
    /// Number of shards
    #[arg(long, value_name = "N", value_parser = count(1..=1_000_000))]
    shards: Option<u32>,
    #[command(flatten)]
    json: JsonArgument,
}

#[derive(Serialize)]
struct Output {
    cases: usize,
    policies: usize,
    trials_each: u32,
    trials: usize,
    jobs: usize,
    seconds_per_trial: f64,
    seconds: f64,
    bytes: u64,
    bytes_while_running: u64,
    bytes_by_keep: BTreeMap<&'static str, u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    shard: Option<OneShard>,
    measured: usize,
    simulated: usize,
}

/// The largest of the shards.
#[derive(Serialize)]
struct OneShard {
    shards: u32,
    trials: usize,
    seconds: f64,
    bytes: u64,
    bytes_while_running: u64,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        stop_on_signals();
        let experiment = Experiment::load(&self.file, &self.selection.overrides(), registry)?;
        experiment.check_policies()?;
        let measured = Measured::of(&experiment, self.progress.quiet)?;
        let output = self.output(&experiment, &measured)?;
        if self.json.json {
            return print_json(&output);
        }
        output.print(out)
    }

    fn output(&self, experiment: &Experiment, measured: &Measured) -> Result<Output, Failure> {
        let trials = experiment.count(None);
        let jobs = self.progress.jobs();
        let Sizes { finished, journal } = measured.sizes(experiment, experiment.keep, None, trials)?;
        let keep = |keep: Keep| Ok((keep.name(), measured.sizes(experiment, keep, None, trials)?.finished));
        let shard = self.shards.map(|shards| one_shard(experiment, measured, shards, jobs)).transpose()?;
        Ok(Output {
            cases: experiment.cases.len(),
            policies: experiment.policies.len(),
            trials_each: experiment.trials,
            trials,
            jobs,
            seconds_per_trial: measured.seconds_each,
            seconds: measured.seconds_each * trials.div_ceil(jobs) as f64,
            bytes: finished,
            bytes_while_running: journal,
            bytes_by_keep: Keep::ALL.into_iter().map(keep).collect::<Result<_, Failure>>()?,
            shard,
            measured: measured.count(),
            simulated: measured.simulated,
        })
    }
}

fn one_shard(
    experiment: &Experiment,
    measured: &Measured,
    shards: u32,
    jobs: usize,
) -> Result<OneShard, Failure> {
    let trials = experiment.seeds_of_cases().div_ceil(shards as usize) * experiment.policies.len();
    let shard = Some(Shard { number: 1, of: shards });
    let Sizes { finished, journal } = measured.sizes(experiment, experiment.keep, shard, trials)?;
    let seconds = measured.seconds_each * trials.div_ceil(jobs) as f64;
    Ok(OneShard { shards, trials, seconds, bytes: finished, bytes_while_running: journal })
}

impl Output {
    fn print(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let Self { cases, policies, trials_each, trials, jobs, .. } = self;
        let (cases, policies) = (counted(*cases, "case"), counted(*policies, "policy"));
        let threads = counted(*jobs, "thread");
        writeln!(out, "trials  {trials}: {cases} x {policies} x {trials_each}")?;
        let (time, each) = (duration(self.seconds), self.seconds_per_trial);
        writeln!(out, "time    about {time} on {threads} ({each:.2} s a trial)")?;
        let (bytes, running) = (size(self.bytes), size(self.bytes_while_running));
        writeln!(out, "disk    about {bytes}; the journal takes {running} while it runs")?;
        let keep = |keep: &Keep| format!("{} {}", keep.name(), size(self.bytes_by_keep[keep.name()]));
        let keeps: Vec<String> = Keep::ALL.iter().map(keep).collect();
        writeln!(out, "--keep  {}", keeps.join(", "))?;
        if let Some(OneShard { shards, trials, seconds, bytes, bytes_while_running }) = &self.shard {
            let (time, bytes, running) = (duration(*seconds), size(*bytes), size(*bytes_while_running));
            writeln!(out, "shards  {shards} of up to {trials} trials: each about {time} on {threads},")?;
            writeln!(out, "        {bytes} when it is done, {running} while it runs")?;
        }
        writeln!(
            out,
            "from {} trials, of which policies that decide alike shared {}; times depend on what else the \
             machine does",
            self.measured,
            self.measured - self.simulated
        )?;
        Ok(())
    }
}

/// A time in words.
pub(crate) fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("{s:.0} s"),
        s if s < 6_000.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3_600.0),
    }
}

/// A size in words.
pub(crate) fn size(bytes: u64) -> String {
    match bytes as f64 {
        b if b < 1e6 => format!("{:.0} kB", b / 1e3),
        b if b < 1e9 => format!("{:.1} MB", b / 1e6),
        b => format!("{:.1} GB", b / 1e9),
    }
}
