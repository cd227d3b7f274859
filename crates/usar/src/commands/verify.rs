//! `usar verify`: do the numbers of a finished sweep come out again?

use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use clap::Args;
use experiments::Failure;
use experiments::experiment::{Experiment, Program};
use experiments::provenance::{COMMIT, Manifest};
use experiments::run::{Limits, Outcome, Run, TrialKey, run_all};
use experiments::sweep::disk::{broken_files, experiment_in};
use experiments::sweep::links;
use usar_sim::hash::Link;

use crate::running::{default_jobs, progress_bar};

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

/// A trial that takes longer is given up.
const LONGEST_TRIAL: Duration = Duration::from_hours(1);

impl Arguments {
    pub(crate) fn execute(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let (experiment, manifest) = experiment_in(&self.folder)?;
        let experiment = Arc::new(experiment);
        if manifest.is_lean {
            return Err(Failure::input(format!(
                "{}: its sweep is lean: it has no hashes to compare with",
                self.folder.display()
            )));
        }
        let recorded = links::read(&self.folder)?;
        let all: Vec<TrialKey> = experiment.keys(manifest.shard).collect();
        let chosen = self.choose(&all);
        let jobs = self.jobs.map_or_else(default_jobs, |jobs| jobs as usize);
        self.mention_other_version(&manifest);
        let progress = progress_bar(chosen.len(), "trials", jobs, self.quiet);
        let mut outcomes = Vec::new();
        let again = Arc::clone(&experiment);
        let run: Arc<Run> = Arc::new(move |key, halt| again.run_alone(key, halt));
        run_all(
            chosen,
            Limits { jobs, trial: Some(LONGEST_TRIAL) },
            run,
            &AtomicBool::new(false),
            |outcome| {
                progress.inc(1);
                outcomes.push(outcome);
                Ok(())
            },
        )?;
        outcomes.sort_by(|a, b| a.key.cmp(&b.key));
        progress.finish_and_clear();

        let nothing = Vec::new();
        let recorded =
            |key: &TrialKey| recorded.get(&(key.case, key.label.clone(), key.trial)).unwrap_or(&nothing);
        let differences: Vec<String> = outcomes
            .iter()
            .filter_map(|outcome| difference(outcome, recorded(&outcome.key), &experiment))
            .collect();
        let count = outcomes.len();
        let of_all = if count < all.len() { format!(" (of {})", all.len()) } else { String::new() };
        for name in broken_files(&self.folder, &manifest) {
            eprintln!("{}: does not have the checksum of the manifest", self.folder.join(name).display());
        }
        match differences.first() {
            None if !broken_files(&self.folder, &manifest).is_empty() => Err(Failure::run(format!(
                "{count} of {count} trials{of_all} match, but files were changed since"
            ))),
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

    /// Numbers are promised for the same program only.
    fn mention_other_version(&self, manifest: &Manifest) {
        let Program { version, source } = Program::this();
        if !self.quiet && (manifest.version != version || manifest.source != source) {
            eprintln!(
                "note: the sweep is of usar {} ({}), this is usar {version} ({COMMIT})",
                manifest.version, manifest.commit
            );
        }
    }
}

/// Where a trial first differs from its recorded chain.
fn difference(outcome: &Outcome, recorded: &[Link], experiment: &Experiment) -> Option<String> {
    let TrialKey { case, label, trial, seed, .. } = &outcome.key;
    let case = &experiment.cases[*case];
    let name = format!("{}trial {trial} of {label} (seed {seed})", experiment.describe(case));
    let again = outcome.record().map(|record| record.chain.links()).unwrap_or_default();
    let pairs = recorded.iter().zip(again);
    if let Some((before, now)) = pairs.clone().find(|(before, now)| before != now) {
        let time_s = now.step as f64 * case.scenario.dt_s;
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
