//! Outcomes of earlier rounds. They are part of the question, so that a learning policy is still a function
//! of its question.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ids::TaskId;

/// One round that is over.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RoundOutcome {
    /// Number of the round, from 1.
    pub round: u32,
    /// From its start until it was complete, in seconds.
    pub duration_s: f64,
    /// One group for each task, in the order of the table of tasks.
    pub groups: Vec<GroupOutcome>,
}

/// What one group did in one round.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GroupOutcome {
    /// Its task.
    pub task: TaskId,
    /// Rescuees delivered from the task.
    pub rescued: u32,
    /// Energy that its members spent, in the unit of the scenario's costs: percent points, or points.
    pub energy: f64,
    /// HP that its members lost, in the same unit.
    pub hp: f64,
    /// Its members, by id.
    pub members: Vec<MemberOutcome>,
}

/// What one member did in one round.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MemberOutcome {
    /// The robot.
    pub id: u32,
    /// Rescuees that it delivered.
    pub rescued: u32,
    /// Energy that it spent, in the unit of the scenario's costs: percent points, or points.
    pub energy: f64,
    /// HP that it lost, in the same unit.
    pub hp: f64,
    /// Whether it turned back to rest before its group went home.
    pub turned_back: bool,
    /// Whether it was stranded or disabled.
    pub lost: bool,
}
