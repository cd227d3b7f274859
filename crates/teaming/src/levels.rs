//! Levels: what falls while robots work and is filled by a rest. The question has a table of them, by name.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The level of the battery. Estimators compare what group-mates spent of it.
pub const ENERGY: &str = "energy";

/// The level of health.
pub const HP: &str = "hp";

/// The unit of levels: percent of the robot's own maximum.
pub const PERCENT: &str = "%";

/// A level that robots have.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Level {
    /// Its name: "energy", "hp".
    pub name: String,
    /// Its unit: "%", percent of the robot's own maximum, and no other.
    pub unit: String,
    /// A robot whose level is below it rests. 0 where that is not known.
    #[serde(default)]
    pub threshold: f64,
    /// What the base expects of it before the first report; absent where it expects nothing.
    #[serde(default)]
    pub expected: Option<Expected>,
}

/// What is expected of a level.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Expected {
    /// Its mean.
    pub mean: f64,
    /// Its standard deviation.
    pub sd: f64,
}

/// What a rest fills.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum Rest {
    /// All levels. The default.
    #[default]
    All,
    /// Only the level that is low: the lowest one.
    Low,
}

impl Level {
    /// A level in percent of which no more is known than its name.
    #[must_use]
    pub fn new(name: &str) -> Self {
        Self { name: name.to_owned(), unit: PERCENT.to_owned(), threshold: 0.0, expected: None }
    }

    /// The levels of the battery and of health, in this order.
    #[must_use]
    pub fn energy_and_hp() -> Vec<Self> {
        [ENERGY, HP].map(Self::new).to_vec()
    }

    /// Whether it is in percent, and its numbers are finite.
    pub(crate) fn is_usable(&self) -> bool {
        let Expected { mean, sd } = self.expected.unwrap_or(Expected { mean: 0.0, sd: 0.0 });
        self.unit == PERCENT && [self.threshold, mean, sd].into_iter().all(f64::is_finite)
    }
}
