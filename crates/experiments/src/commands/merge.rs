//! `usar merge`: the shards of a sweep as one folder, the bytes of a single run.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::Args;

use super::sweep::print;
use crate::experiment::Program;
use crate::failure::Failure;
use crate::sweep::folder::{Folder, Opening, experiment_in};

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
        let mut shards = self.folders.iter().map(|path| Folder::read(path)).collect::<Result<Vec<_>, _>>()?;
        let first = shards[0].manifest().clone();
        let this = Program::this();
        if (&first.version, &first.source) != (&this.version, &this.source) {
            return Err(Failure::input(format!(
                "{} is of usar {} with source {}; this is {} with source {}: merge with the program that ran the shards",
                self.folders[0].display(),
                first.version,
                first.source,
                this.version,
                this.source
            )));
        }
        for shard in &shards {
            let mut differences = first.differences(shard.manifest());
            differences.retain(|difference| !difference.starts_with("shard: "));
            differences.extend(crate::provenance::scenario_differences(
                &shards[0].experiment().base.resolved(),
                &shard.experiment().base.resolved(),
            ));
            if first.trials != shard.manifest().trials {
                differences.push(format!("trials: {} there, {} now", first.trials, shard.manifest().trials));
            }
            if !differences.is_empty() {
                let (one, other) = (self.folders[0].display(), shard.path().display());
                let differences = differences.join("\n  ");
                return Err(Failure::input(format!(
                    "{one} and {other} are not of one sweep:\n  {differences}"
                )));
            }
        }
        let mut lines = BTreeMap::new();
        for shard in &mut shards {
            for (place, measured) in shard.results().clone() {
                let line = shard.line(place)?;
                let path = shard.path().to_owned();
                if let Some((other, _, from)) = lines.insert(place, (line.clone(), measured, path.clone()))
                    && other != line
                {
                    let key = shard.experiment().key(place);
                    return Err(Failure::input(format!(
                        "{} and {} disagree about trial {} of {} (seed {})",
                        from.display(),
                        path.display(),
                        key.trial,
                        key.label,
                        key.seed
                    )));
                }
            }
        }
        let (experiment, _) = experiment_in(&self.folders[0])?;
        let missing: Vec<String> = experiment
            .keys(None)
            .filter(|key| !lines.contains_key(&(key.case, key.policy, key.trial)))
            .map(|key| {
                format!(
                    "{}trial {} of {}",
                    experiment.describe(&experiment.cases[key.case]),
                    key.trial,
                    key.label
                )
            })
            .collect();
        if !missing.is_empty() {
            let more = if missing.len() > MAX_NAMED { ", ..." } else { "" };
            let named = missing[..missing.len().min(MAX_NAMED)].join(", ");
            return Err(Failure::input(format!("{} trials are missing: {named}{more}", missing.len())));
        }
        let mut whole = Folder::open(&self.out, Arc::new(experiment), Opening::default(), &mut |note| {
            eprintln!("note: {note}");
        })?;
        for (place, (line, measured, _)) in lines {
            whole.add_line(&line, place, measured)?;
        }
        whole.finish(&AtomicBool::new(false))?;
        print(out, &whole)
    }
}
