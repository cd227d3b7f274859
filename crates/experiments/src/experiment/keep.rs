//! What a sweep keeps of each trial.

use std::str::FromStr;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

ron_tree::named! {
    /// What a sweep keeps of each trial. Each keeps what those before it keep.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
    pub enum Keep {
        /// Its row of `trials.csv`: every metric.
        Trials = "trials",
        /// Its record with all decisions, and `rounds.csv`.
        Rounds = "rounds",
        /// `robots.csv` as well.
        Robots = "robots",
        /// `groups.csv`, `series.csv`, `hashes.csv` with the hash chain, `links.csv` with the messages of
        /// each link, and what policies say of their decisions.
        #[default]
        Groups = "groups",
    }
}

impl Keep {
    /// Whether the records of trials are kept, with rounds and decisions.
    pub fn has_records(self) -> bool {
        self >= Self::Rounds
    }

    /// Whether hash chains are kept.
    pub fn has_chains(self) -> bool {
        self >= Self::Groups
    }
}

impl FromStr for Keep {
    type Err = UnknownKeep;

    fn from_str(text: &str) -> Result<Self, UnknownKeep> {
        let found = Self::ALL.into_iter().find(|keep| keep.name() == text);
        found.ok_or_else(|| UnknownKeep { found: text.to_owned() })
    }
}

/// A word that is no [`Keep`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("must be trials, rounds, robots or groups, found {found:?}")]
pub struct UnknownKeep {
    /// The word.
    pub found: String,
}
