//! Shared arguments of commands that run or plan a sweep: which trials, and what is kept of them.

use clap::Args;
use experiments::experiment::{Keep, Overrides, split_list};

/// Which trials of a sweep are meant, and what is kept of them.
#[derive(Debug, Args)]
pub(crate) struct Chosen {
    /// Policies, separated by commas, with options in brackets [default: the file's]
    #[arg(long)]
    policies: Option<String>,
    /// Trials for each policy and case [default: the file's]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) trials: Option<u32>,
    /// Seed of the first trial [default: the file's]
    #[arg(long)]
    seed: Option<u64>,
    /// Set a field of the scenario, by its path, to a value in RON, e.g. `costs.energy.per_step=0.009`; may
    /// stand several times
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Check every invariant at every step; a violation ends the trial as failed
    #[arg(long)]
    check: bool,
    /// What to keep of each trial: its metrics (trials), its rounds and decisions too (rounds), its robots
    /// too (robots), or everything (groups) [default: the file's, or groups]
    #[arg(long, value_name = "trials|rounds|robots|groups")]
    keep: Option<Keep>,
}

impl Chosen {
    pub(crate) fn overrides(&self) -> Overrides {
        let policies = self.policies.as_deref();
        Overrides {
            policies: policies.map(|list| split_list(list).into_iter().map(str::to_owned).collect()),
            trials: self.trials,
            first_seed: self.seed,
            set: self.set.clone(),
            is_checked: self.check,
            keep: self.keep,
        }
    }

    /// The same choices as arguments of a command.
    pub(crate) fn arguments(&self) -> Vec<String> {
        let mut arguments = Vec::new();
        let mut add = |flag: &str, value: Option<String>| {
            arguments.extend(value.into_iter().flat_map(|value| [flag.to_owned(), value]));
        };
        add("--policies", self.policies.clone());
        add("--trials", self.trials.map(|trials| trials.to_string()));
        add("--seed", self.seed.map(|seed| seed.to_string()));
        self.set.iter().for_each(|entry| add("--set", Some(entry.clone())));
        add("--keep", self.keep.map(|keep| keep.name().to_owned()));
        arguments.extend(self.check.then(|| "--check".to_owned()));
        arguments
    }
}
