//! What a robot's actions and radiation cost.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Costs of moving or of radiation, in the unit of the scenario's costs (percent of the robot's own maximum,
/// or points). The three add up.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rates {
    /// Per simulation step, as the paper prints it (energy: a step in which the robot moves; HP: a step
    /// inside a zone).
    pub per_step: f64,
    /// Per metre travelled (HP: inside a zone).
    pub per_metre: f64,
    /// Per second (energy: of duty, at rest places excepted; HP: inside a zone).
    pub per_second: f64,
}

/// What work costs, in the same unit.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct WorkRates {
    /// Energy per second of loading.
    pub energy_per_second: f64,
    /// HP per second in the area of the robot's own task.
    pub hp_per_second: f64,
}
