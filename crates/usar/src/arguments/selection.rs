//! Which trials of a sweep are run, and what is kept of them.

use std::path::PathBuf;

use clap::Args;
use experiments::experiment::{Keep, Overrides};

use super::{PoliciesArgument, SetArguments, count, one_seed};
use crate::library;

/// Which trials of a sweep are run or planned, and what is kept of them.
#[derive(Debug, Args)]
pub(crate) struct Selection {
    #[command(flatten)]
    world: WorldArgument,
    #[command(flatten)]
    policies: PoliciesArgument,
    /// Trials of each policy, in each case or candidate [default: the file's]
    #[arg(long, value_parser = count(1..=1_000_000))]
    pub(crate) trials: Option<u32>,
    /// Seed of the first trial [default: the file's]
    #[arg(long, hide_short_help = true, value_parser = one_seed)]
    first_seed: Option<u64>,
    #[command(flatten)]
    set: SetArguments,
    /// Check every invariant at every step; a violation ends the trial as failed
    #[arg(long, hide_short_help = true)]
    check: bool,
    /// What to keep of each trial: its metrics (trials), its rounds and decisions too (rounds), its robots
    /// too (robots), or everything (groups) [default: the file's, or groups]
    #[arg(long, value_name = "trials|rounds|robots|groups", hide_short_help = true)]
    keep: Option<Keep>,
}

/// In which world a sweep file is run.
#[derive(Debug, Args)]
pub(crate) struct WorldArgument {
    /// Scenario instead of the sweep file's; its name is added to that of the sweep
    #[arg(long, value_name = "FILE", hide_short_help = true, value_parser = library::path)]
    pub(crate) scenario: Option<PathBuf>,
}

impl Selection {
    pub(crate) fn overrides(&self) -> Overrides {
        Overrides {
            policies: self.policies.list(),
            trials: self.trials,
            first_seed: self.first_seed,
            set: self.set.set.clone(),
            is_checked: self.check,
            keep: self.keep,
            scenario: self.world.scenario.clone(),
        }
    }

    /// The same choices as arguments of a command.
    pub(crate) fn arguments(&self) -> Vec<String> {
        let mut arguments = Vec::new();
        let mut add = |flag: &str, value: Option<String>| {
            arguments.extend(value.into_iter().flat_map(|value| [flag.to_owned(), value]));
        };
        add("--scenario", self.world.scenario.as_ref().map(|path| path.display().to_string()));
        add("--policies", self.policies.policies.clone());
        add("--trials", self.trials.map(|trials| trials.to_string()));
        add("--first-seed", self.first_seed.map(|seed| seed.to_string()));
        self.set.set.iter().for_each(|entry| add("--set", Some(entry.clone())));
        add("--keep", self.keep.map(|keep| keep.name().to_owned()));
        arguments.extend(self.check.then(|| "--check".to_owned()));
        arguments
    }
}
