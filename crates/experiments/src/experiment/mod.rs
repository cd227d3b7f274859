//! Experiments: a scenario or a sweep file, resolved into cases, policies and trials.

mod again;
mod cost;
mod file;
mod grid;
mod idle;
mod keep;
mod plan;
mod policy;
mod program;
mod raters;
mod read;
mod setting;
mod shard;
mod start;
mod sweep_file;

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use store::{Failure, refuse};
use teaming::Registry;
use xxhash_rust::xxh3::xxh3_128;

use scenario::{Scenario, parse_tree, read_text};

pub use cost::{Cost, check_cost};
pub use file::sweep_schema;
pub use grid::{Axis, Case, VARIANT};
pub use keep::{Keep, UnknownKeep};
pub use plan::AnalysisPlan;
pub use policy::{PolicySpec, split_list, with_oracle};
pub use program::{Digest, Program, SOURCE};
pub use read::{companion, defaults, with_settings};
pub use shard::{NoShard, Place, Shard};
pub use sweep_file::SweepFileError;

use crate::limits::TRIALS;
use crate::metric::Catalogue;
use crate::run::{Fault, Player, Sessions, SharedTrials, Trial, TrialKey, TrialSetup, run_trial};
pub(crate) use grid::deciding_text;
use grid::{cases, checked_policies};
pub(crate) use policy::{name_and_options, protocol_of};
pub(crate) use read::check_form;
use read::{from_scenario, with_readings};
use setting::overlapping;
use sweep_file::from_sweep_file;

/// The seeds of the trials.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Seeds {
    /// They count up from the first.
    From(u64),
    /// Each trial has its own listed seed.
    Listed(Vec<u64>),
}

/// Settings of the command line that replace those of the file.
#[derive(Debug, Clone, Default)]
pub struct Overrides {
    /// Policies instead of the file's.
    pub policies: Option<Vec<String>>,
    /// Trials for each case and policy.
    pub trials: Option<u32>,
    /// Seed of the first trial.
    pub first_seed: Option<u64>,
    /// Fields to set, as `path=value`.
    pub set: Vec<String>,
    /// Check every invariant at every step.
    pub is_checked: bool,
    /// What to keep of each trial.
    pub keep: Option<Keep>,
    /// The scenario of a sweep file, instead of the one that it names. Its name is added to the sweep's.
    pub scenario: Option<PathBuf>,
}

/// A sweep, ready to run.
pub struct Experiment {
    /// Names the folder of results.
    pub name: String,
    /// Text of the file that it was read from.
    pub given: String,
    /// The scenario before any axis is set.
    pub base: Scenario,
    /// The axes; none for one case.
    pub axes: Vec<Axis>,
    /// The grid, the last axis fastest; one case without axes.
    pub cases: Vec<Case>,
    /// The policies to compare.
    pub policies: Vec<PolicySpec>,
    /// The policies that there are.
    pub registry: Registry,
    /// The metrics of each trial.
    pub metrics: Catalogue,
    /// Number of paired trials for each case and policy.
    pub trials: u32,
    /// Seeds of the trials.
    pub seeds: Seeds,
    /// Whether every invariant is checked at every step.
    pub is_checked: bool,
    /// What is kept of each trial.
    pub keep: Keep,
    /// What is asked of the results.
    pub plan: AnalysisPlan,
    /// The program that runs the sweep, or ran it.
    pub program: Program,
    /// For each case and policy, a hash of everything that decides its numbers, except the seed.
    ids: Vec<Vec<u128>>,
    shared: SharedTrials,
}

/// The parts of an experiment before assembly.
pub(crate) struct Parts {
    pub name: String,
    pub given: String,
    pub base: Scenario,
    pub axes: Vec<Axis>,
    pub policies: Vec<String>,
    pub registry: Registry,
    pub trials: u32,
    pub seeds: Seeds,
    pub is_checked: bool,
    pub keep: Keep,
    pub plan: AnalysisPlan,
    /// The program that made the results; `None` for this one.
    pub program: Option<Program>,
}

impl Experiment {
    /// Reads a scenario or a sweep file, with policies of a registry.
    ///
    /// # Errors
    /// Bad input, with file, line, field, rule and found value.
    pub fn load(path: &Path, overrides: &Overrides, registry: &Registry) -> Result<Self, Failure> {
        Self::parse(read_text(path).map_err(Failure::input)?, path, overrides, registry)
    }

    /// Reads the text of a scenario or a sweep file. `path` says where its scenario is, and appears in
    /// messages.
    ///
    /// # Errors
    /// Those of [`Experiment::load`].
    pub fn parse(
        text: String,
        path: &Path,
        overrides: &Overrides,
        registry: &Registry,
    ) -> Result<Self, Failure> {
        let is_sweep = parse_tree(&text, path).map_err(Failure::input)?.get("scenario").is_some();
        let (mut parts, readings) = if is_sweep {
            from_sweep_file(text, path, overrides.scenario.as_deref(), registry)?
        } else if overrides.scenario.is_some() {
            refuse!("--scenario: is for a sweep file, and {} is a scenario itself", path.display());
        } else {
            from_scenario(text, path, registry)?
        };
        parts.base = with_settings(&parts.base, &overrides.set)?;
        let tree = parts.base.tree();
        let set = overrides.set.iter().map(|entry| entry.split('=').next().unwrap_or_default().trim());
        let on_axis = |path| overlapping(&tree, parts.axes.iter().flat_map(Axis::paths), path);
        if let Some(path) = set.into_iter().find_map(on_axis) {
            refuse!("--set: {path} is on an axis of this sweep");
        }
        if let Some(policies) = &overrides.policies {
            parts.policies.clone_from(policies);
        }
        if let Some(first) = overrides.first_seed {
            parts.seeds = Seeds::From(first);
        }
        if !readings.is_empty() && !parts.policies.iter().any(|policy| policy.trim() == "RNE") {
            refuse!("`readings` vary the policy RNE, but this sweep does not run RNE. Add it to `policies`.");
        }
        parts.policies = with_readings(parts.policies, &readings, registry);
        parts.trials = overrides.trials.unwrap_or(parts.trials);
        parts.is_checked = overrides.is_checked;
        parts.keep = overrides.keep.unwrap_or(parts.keep);
        Self::assemble(parts)
    }

    /// Puts the parts together and checks them.
    ///
    /// # Errors
    /// A policy, an axis or a case cannot be used.
    pub(crate) fn assemble(parts: Parts) -> Result<Self, Failure> {
        let Parts { name, given, base, axes, policies, registry, trials, seeds, .. } = parts;
        let Parts { is_checked, keep, plan, program, .. } = parts;
        let policies = checked_policies(&policies, &registry)?;
        if let Seeds::Listed(list) = &seeds
            && list.len() < trials as usize
        {
            refuse!("trials: must be at most the number of listed seeds, {}, found {trials}", list.len());
        }
        if let Seeds::From(first) = &seeds
            && first.checked_add(u64::from(trials)).is_none()
        {
            refuse!("seeds: {trials} from {first} on go beyond the greatest seed");
        }
        if !TRIALS.allows(trials as usize) {
            let most = TRIALS.most;
            refuse!("trials: must be a count from 1 to {most}, found {trials}");
        }
        let cases = cases(&base, &axes)?;
        let program = program.map_or_else(|| permitted(&policies), Ok)?;
        let id = |case: &Case, (i, policy): (usize, &PolicySpec)| {
            let (program, made) = (program.deciding(i), policy.made());
            let scenario = deciding_text(&case.scenario);
            let text = format!("{program} {is_checked} {} {} {scenario}", made.name, made.options);
            xxh3_128(text.as_bytes())
        };
        let ids = |case| policies.iter().enumerate().map(|policy| id(case, policy)).collect();
        let ids = cases.iter().map(ids).collect();
        let all: Vec<&Scenario> = cases.iter().map(|case| &case.scenario).chain([&base]).collect();
        let metrics = Catalogue::of_cases(&base, &all);
        let plan = plan.checked(&metrics)?;
        let has = |label: &String| policies.iter().any(|policy| policy.label == *label);
        let plan = AnalysisPlan { baseline: plan.baseline.filter(has), ..plan };
        Ok(Self {
            name,
            given,
            metrics,
            base,
            axes,
            cases,
            policies,
            registry,
            trials,
            seeds,
            is_checked,
            keep,
            plan,
            program,
            ids,
            shared: SharedTrials::default(),
        })
    }

    /// A hash of everything that decides the numbers of a trial, in 32 hexadecimal digits: the resolved
    /// scenario, the policy with its options, the seed, and the program.
    pub fn id(&self, key: &TrialKey) -> String {
        let rest = self.ids[key.case][key.policy];
        format!("{:032x}", xxh3_128(format!("{rest:032x} {}", key.seed).as_bytes()))
    }

    /// The key of a trial: its place, its seed, and its policy's label.
    pub fn key(&self, place: Place) -> TrialKey {
        let (case, policy, trial) = place;
        TrialKey { case, policy, trial, seed: self.seed(trial), label: self.policies[policy].label.clone() }
    }

    /// Runs one trial with the sessions of this thread, or takes over the trial of a policy that formed the
    /// same groups in every round.
    ///
    /// # Errors
    /// The reason why the trial did not come to its end.
    pub fn run(&self, key: &TrialKey, sessions: &mut Sessions, halt: &AtomicBool) -> Result<Trial, Fault> {
        let player = self.player(key, sessions)?;
        self.shared.run(key.case, &self.setup(key), player, halt)
    }

    fn player<'s>(&self, key: &TrialKey, sessions: &'s mut Sessions) -> Result<Player<'s>, Fault> {
        let policy = self.policies[key.policy].made();
        sessions.of(key.policy, policy).map_err(|error| Fault::of_policy(&error))
    }

    fn setup(&self, key: &TrialKey) -> TrialSetup<'_> {
        let scenario = &self.cases[key.case].scenario;
        TrialSetup { scenario, seed: key.seed, is_checked: self.is_checked }
    }

    /// Number of trials that [`Experiment::run`] simulated instead of taking them over.
    pub fn simulated(&self) -> usize {
        self.shared.simulated()
    }

    /// Frees the trials that policies could share.
    pub fn forget_shared(&self) {
        self.shared.forget();
    }

    /// Simulates one trial without looking at trials of other policies.
    ///
    /// # Errors
    /// The reason why the trial did not come to its end.
    pub fn run_alone(
        &self,
        key: &TrialKey,
        sessions: &mut Sessions,
        halt: &AtomicBool,
    ) -> Result<Trial, Fault> {
        run_trial(&self.setup(key), self.player(key, sessions)?.session, halt)
    }

    /// The same sweep with another number of trials.
    ///
    /// # Errors
    /// More trials than listed seeds.
    pub fn with_trials(&self, trials: u32) -> Result<Self, Failure> {
        Self::assemble(Parts {
            name: self.name.clone(),
            given: self.given.clone(),
            base: self.base.clone(),
            axes: self.axes.clone(),
            policies: self.policies.iter().map(|policy| policy.written().to_owned()).collect(),
            registry: self.registry.clone(),
            trials,
            seeds: self.seeds.clone(),
            is_checked: self.is_checked,
            keep: self.keep,
            plan: self.plan.clone(),
            program: Some(self.program.clone()),
        })
    }

    /// Largest number of trials for which there are seeds.
    pub fn most_trials(&self) -> u32 {
        match &self.seeds {
            Seeds::From(_) => u32::MAX,
            Seeds::Listed(list) => list.len() as u32,
        }
    }

    /// Seed of a trial; trials are numbered from 1.
    pub fn seed(&self, trial: u32) -> u64 {
        match &self.seeds {
            Seeds::From(first) => first.wrapping_add(u64::from(trial - 1)),
            Seeds::Listed(list) => list[trial as usize - 1],
        }
    }

    /// A case's values of the axes, followed by a colon; empty without axes.
    pub fn describe(&self, case: &Case) -> String {
        let places: Vec<String> = self
            .axes
            .iter()
            .zip(&case.values)
            .map(|(axis, value)| format!("{}={value}", axis.path))
            .collect();
        if places.is_empty() { String::new() } else { format!("{}: ", places.join(", ")) }
    }
}

/// The running program with these policies, none of which may start a program that nobody has allowed.
fn permitted(policies: &[PolicySpec]) -> Result<Program, Failure> {
    for spec in policies {
        let refused = |error| Failure::input(format!("policy {}: {error}", spec.label));
        spec.made().it.permission().map_err(refused)?;
    }
    Program::running(policies)
}
