//! Shared arguments of `sensitivity` and `search`: a scenario, parameters that vary, and policies.

use std::path::PathBuf;

use clap::Args;
use experiments::Failure;
use experiments::experiment::{Experiment, Overrides};
use rne_core::Registry;

use crate::running::default_jobs;

/// A scenario and its parameters.
#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub(crate) struct ExploredArguments {
    /// Scenario or sweep file without axes (RON)
    pub(super) file: PathBuf,
    /// A parameter and its range: `PATH=LOW..HIGH`; `PATH + PATH*RATIO=LOW..HIGH log` sets several fields and
    /// goes by factors; `[*]` is every entry of a list; can be given several times
    #[arg(long, value_name = "PATH=LOW..HIGH", required = true)]
    pub(super) over: Vec<String>,
    /// Set a field that does not vary; can be given several times
    #[arg(long, value_name = "PATH=VALUE")]
    pub(super) set: Vec<String>,
    /// Threads [default: one per core]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1024))]
    jobs: Option<u32>,
    /// Start over
    #[arg(long)]
    pub(super) fresh: bool,
    /// Simulate even if it takes very long: more bodies x steps than docs/limits.md has
    #[arg(long)]
    allow_expensive: bool,
    /// No progress on stderr
    #[arg(long)]
    pub(super) quiet: bool,
    /// Print one JSON object
    #[arg(long)]
    pub(super) json: bool,
}

impl ExploredArguments {
    /// The experiment with these policies and this number of trials at a point.
    pub(super) fn experiment(
        &self,
        policies: Option<Vec<String>>,
        trials: u32,
        registry: &Registry,
    ) -> Result<Experiment, Failure> {
        let overrides = Overrides {
            policies,
            trials: Some(trials),
            first_seed: Some(1),
            set: self.set.clone(),
            ..Overrides::default()
        };
        let experiment = Experiment::load(&self.file, &overrides, registry)?;
        experiment.check(self.allow_expensive)?;
        Ok(experiment)
    }

    pub(super) fn jobs(&self) -> usize {
        self.jobs.map_or_else(default_jobs, |jobs| jobs as usize)
    }

    pub(super) fn pool(&self) -> Result<rayon::ThreadPool, Failure> {
        rayon::ThreadPoolBuilder::new().num_threads(self.jobs()).build().map_err(Failure::run)
    }
}
