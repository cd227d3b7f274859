//! `usar sweep`: paired trials of several policies, a table, and a folder of results.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use indicatif::ProgressBar;
use rne_core::{GroupingPolicy, policy_named};
use usar_sim::layout::Layout;
use usar_sim::scenario::{Problem, SampledCounts, Scenario};
use usar_sim::simulation::Simulation;

use super::{default_jobs, load, progress_bar};
use crate::failure::Failure;
use crate::stats::Summary;
use crate::sweep::folder::Draft;
use crate::sweep::{Outcome, TrialKey, keys, run_all};
use crate::table::policy_table;

/// Compare policies over paired trials: the same initial levels for every policy
#[derive(Debug, Args)]
#[command(after_help = "\
Results go to a new folder: trials.csv (a row per trial), rounds.csv, robots.csv, hashes.csv (for `usar verify`), manifest.json, and the
scenario as given (experiment.ron) and as run (resolved.ron). They do not depend on --jobs.

Examples:
  usar sweep scenarios/paper.ron
  usar sweep scenarios/paper.ron --policies RNE,RANDOM --trials 100 --jobs 2 --out results/many")]
pub(crate) struct Arguments {
    /// Scenario file (RON)
    file: PathBuf,
    /// Policies, separated by commas [default: the scenario's]
    #[arg(long, value_delimiter = ',')]
    policies: Option<Vec<String>>,
    /// Trials per policy [default: the scenario's]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    trials: Option<u32>,
    /// Seed of the first trial [default: the scenario's]
    #[arg(long)]
    seed: Option<u64>,
    /// Threads [default: one per core]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1024))]
    jobs: Option<u32>,
    /// Folder for the results; must not exist yet or be empty [default: results/NAME, or the next free results/NAME-N]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Check every invariant at every step; a violation ends the trial as failed
    #[arg(long)]
    check: bool,
    /// No progress on stderr
    #[arg(long)]
    quiet: bool,
}

impl Arguments {
    pub(crate) fn execute(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let (given, text) = load(&self.file)?;
        let scenario = self.resolve(&given)?;
        let policies = scenario
            .sweep
            .policies
            .iter()
            .map(|name| policy_named(name, &scenario.rne).map_err(Failure::input))
            .collect::<Result<Vec<_>, _>>()?;
        self.check_layouts(&scenario)?;
        let draft = Draft::new(self.out.as_deref(), &scenario.name)?;

        let keys = keys(&scenario);
        let jobs = self.jobs.map_or_else(default_jobs, |jobs| jobs as usize);
        let progress = progress_bar(keys.len(), jobs, self.quiet);
        let outcomes = run_all(
            &keys,
            jobs,
            |key| self.trial(&scenario, policies[key.policy].as_ref(), key),
            |outcome| report(&progress, outcome),
        )?;
        progress.finish_and_clear();

        writeln!(
            out,
            "{}",
            policy_table(&scenario.sweep.policies, &Summary::of_all(&scenario.sweep.policies, &outcomes))
        )?;
        writeln!(out, "{}", footnote(&scenario))?;
        let place = draft.publish(&text, &scenario, &outcomes)?;
        if !self.quiet {
            eprintln!("results in {}", place.display());
        }
        let failed: Vec<String> = outcomes.iter().filter_map(Outcome::failure).collect();
        if failed.is_empty() { Ok(()) } else { Err(Failure::run(failed.join("\n"))) }
    }

    fn trial(
        &self,
        scenario: &Scenario,
        policy: &dyn GroupingPolicy,
        key: &TrialKey,
    ) -> Result<usar_sim::record::TrialRecord, String> {
        let simulation = Simulation::new(scenario, policy, key.seed).map_err(|error| error.to_string())?;
        let simulation = if self.check { simulation.checked() } else { simulation };
        Ok(simulation.run(|_, _, _| {}))
    }

    /// The scenario with what the command line says otherwise.
    fn resolve(&self, given: &Scenario) -> Result<Scenario, Failure> {
        let mut file = (**given).clone();
        if let Some(policies) = &self.policies {
            file.sweep.policies.clone_from(policies);
        }
        file.sweep.trials = self.trials.unwrap_or(file.sweep.trials);
        file.sweep.first_seed = self.seed.unwrap_or(file.sweep.first_seed);
        Scenario::try_from(file).map_err(|problems| {
            let line = |p: &Problem| {
                let name = if p.field.starts_with("sweep.policies") { "--policies:" } else { &p.field };
                format!("{name} {}, found {}", p.rule, p.found)
            };
            let lines = problems.iter().map(line);
            Failure::Input(lines.collect::<Vec<_>>().join("\n"))
        })
    }

    /// Draws every layout before the first trial runs, so that a scenario without room fails at once.
    fn check_layouts(&self, scenario: &Scenario) -> Result<(), Failure> {
        let drawn = scenario.sampled.hard != SampledCounts::default()
            || scenario.sampled.easy != SampledCounts::default();
        let trials = if drawn { scenario.sweep.trials } else { 1 };
        for trial in 0..trials {
            let seed = scenario.sweep.first_seed.wrapping_add(u64::from(trial));
            Layout::sample(scenario, seed)
                .map_err(|error| Failure::input(format!("{}: seed {seed}: {error}", self.file.display())))?;
        }
        Ok(())
    }
}

fn report(progress: &ProgressBar, outcome: &Outcome) {
    if let Some(failure) = outcome.failure() {
        progress.suspend(|| eprintln!("{failure}"));
    }
    progress.inc(1);
}

fn footnote(scenario: &Scenario) -> String {
    format!(
        "mean ± sample standard deviation over {} paired trials (seeds {} to {}); energy and HP in percent points per rescuee delivered;\n\
         totals include what robots spent outside a group, on their way to rest",
        scenario.sweep.trials,
        scenario.sweep.first_seed,
        scenario.sweep.first_seed.wrapping_add(u64::from(scenario.sweep.trials) - 1),
    )
}
