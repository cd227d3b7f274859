//! `usar verify`: do the numbers of a finished sweep come out again?

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use rne_core::policy_named;
use serde::Deserialize;
use usar_sim::hash::Link;
use usar_sim::scenario::Scenario;
use usar_sim::simulation::Simulation;

use super::{default_jobs, load, progress_bar};
use crate::failure::Failure;
use crate::sweep::{Outcome, TrialKey, keys, links, run_all};

/// Run a finished sweep again and compare the whole state of every trial, step by step
#[derive(Debug, Args)]
#[command(after_help = "\
Exit status 0 only when every trial that was run again has the same hash chain. Otherwise the first trial, step and part of the state that
differ are named: bodies, robots, debris, rescuees, beliefs, mission, routes, resolver, metrics or events.

Examples:
  usar verify results/paper
  usar verify results/paper --sample 10")]
pub(crate) struct Arguments {
    /// Folder of a finished sweep
    folder: PathBuf,
    /// Run only this many trials, spread evenly over the sweep
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    sample: Option<u32>,
    /// Threads [default: one per core]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1024))]
    jobs: Option<u32>,
    /// No progress on stderr
    #[arg(long)]
    quiet: bool,
}

/// What is read of `manifest.json`.
#[derive(Deserialize)]
struct Origin {
    version: String,
    commit: String,
}

impl Arguments {
    pub(crate) fn execute(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let (scenario, _) = load(&self.folder.join("resolved.ron"))?;
        let recorded = links::read(&self.folder)?;
        let all = keys(&scenario);
        let chosen = self.choose(&all);
        let jobs = self.jobs.map_or_else(default_jobs, |jobs| jobs as usize);
        self.mention_other_version();
        let progress = progress_bar(chosen.len(), jobs, self.quiet);
        let outcomes = run_all(&chosen, jobs, |key| run(&scenario, key), |_| progress.inc(1))?;
        progress.finish_and_clear();

        let nothing = Vec::new();
        let recorded =
            |key: &TrialKey| recorded.get(&(key.policy_name.clone(), key.trial)).unwrap_or(&nothing);
        let differences: Vec<String> = outcomes
            .iter()
            .filter_map(|outcome| difference(outcome, recorded(&outcome.key), &scenario))
            .collect();
        let count = outcomes.len();
        let of_all = if count < all.len() { format!(" (of {})", all.len()) } else { String::new() };
        match differences.first() {
            None => Ok(writeln!(out, "{count} of {count} trials{of_all} match, step by step")?),
            Some(first) => Err(Failure::run(format!(
                "{} of {count} trials{of_all} do not match\n{first}",
                differences.len()
            ))),
        }
    }

    fn choose(&self, all: &[TrialKey]) -> Vec<TrialKey> {
        let count = self.sample.map_or(all.len(), |sample| (sample as usize).min(all.len()));
        (0..count).map(|i| all[i * all.len() / count].clone()).collect()
    }

    /// Numbers are promised for the same version only.
    fn mention_other_version(&self) {
        let text = std::fs::read(self.folder.join("manifest.json")).unwrap_or_default();
        let Ok(origin) = serde_json::from_slice::<Origin>(&text) else { return };
        let (version, commit) = (env!("CARGO_PKG_VERSION"), env!("USAR_COMMIT"));
        if !self.quiet && (origin.version != version || origin.commit != commit) {
            eprintln!(
                "note: the sweep is of usar {} ({}), this is usar {version} ({commit})",
                origin.version, origin.commit
            );
        }
    }
}

fn run(scenario: &Scenario, key: &TrialKey) -> Result<usar_sim::record::TrialRecord, String> {
    let policy = policy_named(&key.policy_name, &scenario.rne).map_err(|error| error.to_string())?;
    let trial = Simulation::new(scenario, &*policy, key.seed).map_err(|error| error.to_string())?;
    Ok(trial.run(|_, _, _| {}))
}

/// Where a trial first differs from its recorded chain.
fn difference(outcome: &Outcome, recorded: &[Link], scenario: &Scenario) -> Option<String> {
    let TrialKey { policy_name, trial, seed, .. } = &outcome.key;
    let name = format!("trial {trial} of {policy_name} (seed {seed})");
    let again = outcome.record().map(|record| record.chain.links()).unwrap_or_default();
    let pairs = recorded.iter().zip(again);
    if let Some((before, now)) = pairs.clone().find(|(before, now)| before != now) {
        let time_s = now.step as f64 * scenario.dt_s;
        let parts = before.differing_parts(now).join(", ");
        let parts = if parts.is_empty() { "the chain only".to_owned() } else { parts };
        return Some(format!("{name} differs first at step {} ({time_s:.2} s), in: {parts}", now.step));
    }
    match (recorded.len(), again.len()) {
        (before, now) if before == now => None,
        (0, _) => Some(format!("{name} has no hashes in the folder: it failed then, and does not now")),
        (_, 0) => outcome.failure(),
        (before, now) => Some(format!("{name} has {before} links in the folder and {now} now")),
    }
}
