//! A scenario and parameters that vary.

use experiments::experiment::{Experiment, Overrides};

use super::{ProgressArguments, SetArguments};
use crate::library;
use crate::prelude::*;

/// A scenario and its parameters.
#[derive(Debug, Args)]
pub(crate) struct ParameterArguments {
    /// Scenario or sweep file without axes (RON)
    #[arg(value_parser = library::path)]
    file: PathBuf,
    /// A parameter and its range: `PATH=LOW..HIGH`; `PATH + PATH*RATIO=LOW..HIGH log` sets several fields and
    /// goes by factors; `[*]` is every entry of a list; `PATH=[VALUE, VALUE]` chooses; can be given several
    /// times
    #[arg(long, value_name = "PATH=LOW..HIGH", required = true)]
    pub(crate) over: Vec<String>,
    #[command(flatten)]
    set: SetArguments,
    /// File or folder to write [default: results/NAME-COMMAND]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Start over: delete what an earlier run has left in the folder
    #[arg(long, hide_short_help = true)]
    pub(crate) fresh: bool,
    /// Simulate even if it takes very long: more bodies x steps than docs/limits.md has
    #[arg(long, hide_short_help = true)]
    allow_expensive: bool,
    #[command(flatten)]
    pub(crate) progress: ProgressArguments,
}

impl ParameterArguments {
    /// The experiment with these policies and this number of trials at a point.
    pub(crate) fn experiment(
        &self,
        policies: Option<Vec<String>>,
        trials: u32,
        registry: &Registry,
    ) -> Result<Experiment, Failure> {
        let overrides = Overrides {
            policies,
            trials: Some(trials),
            first_seed: Some(1),
            set: self.set.set.clone(),
            ..Overrides::default()
        };
        let experiment = Experiment::load(&self.file, &overrides, registry)?;
        experiment.check(self.allow_expensive)?;
        Ok(experiment)
    }

    /// The folder for the log and the results of a command.
    pub(crate) fn folder(&self, experiment: &Experiment, command: &str) -> PathBuf {
        let usual = || Path::new("results").join(format!("{}-{command}", experiment.name));
        self.out.clone().unwrap_or_else(usual)
    }
}
