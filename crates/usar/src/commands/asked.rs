//! The trial that a command is asked about: from a scenario, or from a sweep's folder.

use std::path::PathBuf;

use clap::Args;
use experiments::Failure;
use experiments::experiment::{Experiment, PolicySpec, check_cost, defaults, with_settings};
use experiments::sweep::disk::experiment_in;
use rne_core::{Registry, Session};
use usar_sim::scenario::Scenario;
use usar_sim::simulation::Simulation;

use super::load;
use crate::running::session_of;

/// Which trial.
#[derive(Debug, Args)]
pub(crate) struct TrialArguments {
    /// Scenario file (RON), or the folder of a sweep
    #[arg(value_name = "FILE|DIR")]
    pub(super) file: PathBuf,
    /// Seed of the trial [default: the first of the sweep]
    #[arg(long)]
    seed: Option<u64>,
    /// Case of a sweep with axes, from 1
    #[arg(long, default_value_t = 1)]
    case: usize,
    /// Set a field of the scenario, by its path, to a value in RON; can be given several times
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Simulate even if it takes very long: more bodies x steps than docs/limits.md has
    #[arg(long)]
    allow_expensive: bool,
}

/// A trial, defined by everything that decides its numbers.
pub(super) struct AskedTrial {
    /// The scenario file or the folder that was named.
    pub file: PathBuf,
    pub scenario: Scenario,
    /// The policy that decides in it.
    pub spec: PolicySpec,
    pub seed: u64,
    /// The policies of the sweep to which the trial belongs; empty for a scenario.
    pub policies: Vec<PolicySpec>,
    /// The policies that there are.
    pub registry: Registry,
}

impl TrialArguments {
    /// The trial in which this policy decides. Without a policy, the first policy of the sweep decides.
    pub(super) fn open(
        &self,
        flag: &str,
        policy: Option<&str>,
        registry: &Registry,
    ) -> Result<AskedTrial, Failure> {
        let parse = |text: &str| {
            PolicySpec::parse(text, registry).map_err(|error| Failure::input(format!("{flag}: {error}")))
        };
        if !self.file.is_dir() {
            let (scenario, _) = load(&self.file)?;
            let scenario = with_settings(&scenario, &self.set)?;
            check_cost(&scenario, self.allow_expensive)?;
            let (first_policy, first_seed) = defaults(&self.file)?;
            check_open(&scenario)?;
            let spec = parse(policy.unwrap_or(&first_policy))?;
            let seed = self.seed.unwrap_or(first_seed);
            let (file, policies, registry) = (self.file.clone(), Vec::new(), registry.clone());
            return Ok(AskedTrial { file, scenario, spec, seed, policies, registry });
        }
        let (experiment, _) = experiment_in(&self.file, registry)?;
        let cases = experiment.cases.len();
        let Some(case) = self.case.checked_sub(1).and_then(|case| experiment.cases.get(case)) else {
            return Err(Failure::input(format!("--case: must be from 1 to {cases}, found {}", self.case)));
        };
        let scenario = with_settings(&case.scenario, &self.set)?;
        check_open(&scenario)?;
        let labelled = |label: &str| experiment.policies.iter().find(|spec| spec.label == label).cloned();
        let spec = match policy {
            None => experiment.policies[0].clone(),
            Some(text) => labelled(text).map_or_else(|| parse(text), Ok)?,
        };
        let seed = self.seed.unwrap_or_else(|| experiment.seed(1));
        let Experiment { policies, registry, .. } = experiment;
        Ok(AskedTrial { file: self.file.clone(), scenario, spec, seed, policies, registry })
    }
}

/// Refuses a candidate of a calibration: before it is chosen, no other decision may be tried in it.
fn check_open(scenario: &Scenario) -> Result<(), Failure> {
    let only = &scenario.only_policy;
    if only.is_empty() {
        return Ok(());
    }
    Err(Failure::input(format!(
        "{}: only_policy allows {only} alone: no decision can be tried otherwise",
        scenario.name
    )))
}

impl AskedTrial {
    /// The trial before its first step.
    pub(super) fn begin(&self) -> Result<Simulation, Failure> {
        let Self { scenario, seed, .. } = self;
        Simulation::new(scenario, *seed)
            .map_err(|error| Failure::input(format!("{}, seed {seed}: {error}", scenario.name)))
    }

    /// A session of the policy that decides, at the beginning of the trial.
    pub(super) fn session(&self) -> Result<Box<dyn Session>, Failure> {
        session_of(&self.spec, &self.scenario, self.seed)
    }

    /// Names of the tasks.
    pub(super) fn tasks(&self) -> Vec<String> {
        experiments::metric::task_names(&self.scenario)
    }
}
