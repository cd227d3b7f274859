//! `usar merge`: the shards of a sweep as one folder, the bytes of a single run.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;
use experiments::Failure;
use experiments::experiment::{Experiment, Program, Shard};
use experiments::provenance::scenario_differences;
use experiments::run::TrialKey;
use experiments::sweep::Place;
use experiments::sweep::disk::experiment_in;
use experiments::sweep::folder::{Folder, Opening};
use xxhash_rust::xxh3::xxh3_128;

use super::sweep::print;
use crate::running::{STOP, stop_on_signals, tell};

/// How many missing trials are named.
const MAX_NAMED: usize = 5;

/// Join the shards of a sweep: the result is the bytes of a single run
#[derive(Debug, Args)]
#[command(after_help = "\
Refuses shards of different sweeps or programs, shards that disagree about a trial, and a sum of shards that lacks a trial.

Example:
  usar sweep scenarios/sweeps/energy.ron --shard 1/2     (on one machine)
  usar sweep scenarios/sweeps/energy.ron --shard 2/2     (on another)
  usar merge results/energy-1-of-2 results/energy-2-of-2 --out results/energy")]
pub(crate) struct Arguments {
    /// Folders of shards
    #[arg(required = true)]
    folders: Vec<PathBuf>,
    /// Folder for the whole
    #[arg(long)]
    out: PathBuf,
}

impl Arguments {
    pub(crate) fn execute(&self, out: &mut dyn Write) -> Result<(), Failure> {
        stop_on_signals();
        let mut shards = self.folders.iter().map(|path| Folder::read(path)).collect::<Result<Vec<_>, _>>()?;
        check_same_sweep(&shards)?;
        let sources = sources(&mut shards)?;
        let (experiment, _) = experiment_in(&self.folders[0])?;
        check_complete(&experiment, &sources, &shards)?;
        let mut whole = Folder::open(&self.out, Arc::new(experiment), Opening::default(), &mut |note| {
            tell(format_args!("note: {note}"));
        })?;
        for (place, (source, _)) in sources {
            if !whole.has(&whole.experiment().key(place)) {
                let measured = shards[source].results()[&place].clone();
                whole.add_line(&shards[source].line(place)?, place, measured)?;
            }
        }
        whole.finish(&STOP)?;
        print(out, &whole)?;
        let failed: Vec<&str> =
            whole.results().values().filter_map(|measured| measured.failure.as_deref()).collect();
        if failed.is_empty() { Ok(()) } else { Err(Failure::run(failed.join("\n"))) }
    }
}

/// Refuses shards of another program than this one, and shards of different sweeps.
fn check_same_sweep(shards: &[Folder]) -> Result<(), Failure> {
    let (first, this) = (shards[0].manifest(), Program::this());
    if (&first.version, &first.source) != (&this.version, &this.source) {
        return Err(Failure::input(format!(
            "{} is of usar {} with source {}; this is {} with source {}: merge with the program that ran the shards",
            shards[0].path().display(),
            first.version,
            first.source,
            this.version,
            this.source
        )));
    }
    let resolved = shards[0].experiment().base.resolved();
    for shard in shards {
        let mut differences = first.differences(shard.manifest());
        differences.extend(scenario_differences(&resolved, &shard.experiment().base.resolved()));
        if first.trials != shard.manifest().trials {
            differences.push(format!("trials: {} there, {} now", first.trials, shard.manifest().trials));
        }
        if !differences.is_empty() {
            let (one, other) = (shards[0].path().display(), shard.path().display());
            let differences = differences.join("\n  ");
            return Err(Failure::input(format!("{one} and {other} are not of one sweep:\n  {differences}")));
        }
    }
    Ok(())
}

/// For each trial, the first shard that has it and a hash of its line; shards that disagree are refused.
fn sources(shards: &mut [Folder]) -> Result<Sources, Failure> {
    let paths: Vec<PathBuf> = shards.iter().map(|shard| shard.path().to_owned()).collect();
    let mut sources = Sources::new();
    for (i, shard) in shards.iter_mut().enumerate() {
        for place in shard.results().keys().copied().collect::<Vec<_>>() {
            let hash = xxh3_128(&shard.line(place)?);
            let (source, known) = *sources.entry(place).or_insert((i, hash));
            if known != hash {
                let TrialKey { trial, label, seed, .. } = shard.experiment().key(place);
                return Err(Failure::input(format!(
                    "{} and {} disagree about trial {trial} of {label} (seed {seed})",
                    paths[source].display(),
                    paths[i].display()
                )));
            }
        }
    }
    Ok(sources)
}

type Sources = BTreeMap<Place, (usize, u128)>;

/// Refuses shards that lack a trial, naming the shards that are not there and the first trials.
fn check_complete(experiment: &Experiment, sources: &Sources, shards: &[Folder]) -> Result<(), Failure> {
    let is_missing = |key: &TrialKey| !sources.contains_key(&(key.case, key.policy, key.trial));
    let name = |key: TrialKey| {
        let case = experiment.describe(&experiment.cases[key.case]);
        format!("{case}trial {} of {}", key.trial, key.label)
    };
    let missing: Vec<String> = experiment.keys(None).filter(is_missing).map(name).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let more = if missing.len() > MAX_NAMED { ", ..." } else { "" };
    let named = missing[..missing.len().min(MAX_NAMED)].join(", ");
    Err(Failure::input(format!("{}missing trials, {}: {named}{more}", absent_shards(shards), missing.len())))
}

/// Which of the shards are not there, in words; nothing where all are.
fn absent_shards(shards: &[Folder]) -> String {
    let there: Vec<Shard> = shards.iter().filter_map(|folder| folder.manifest().shard).collect();
    let Some(first) = there.first() else { return String::new() };
    let is_there = |number: &u32| there.iter().any(|shard| shard.of == first.of && shard.number == *number);
    let absent: Vec<String> = (1..=first.of)
        .filter(|number| !is_there(number))
        .map(|number| format!("{number}/{}", first.of))
        .collect();
    if absent.is_empty() { String::new() } else { format!("shard {} is not there: ", absent.join(", ")) }
}
