//! The outcome of every other assignment: each assignment is played in the trial that asks, with the same
//! random streams.
//!
//! The paper's team of six carriers, four suppliers and two observers has 240 assignments over two tasks. A
//! policy with perfect foresight would choose the best of them. The *regret* of a decision is its distance
//! from the best one. Robots of one role differ at least in their positions. No robot is therefore
//! exchangeable for another, and every assignment is played.

mod branch;
mod decider;
mod objective;
mod survey;

use std::ops::RangeInclusive;

pub use branch::{Branch, BranchError, Outcome, advance_to, play};
pub use decider::{Horizon, Oracle, OracleOptions, kind};
pub use objective::{Objective, UnknownObjective};
pub use survey::{Coverage, Evaluation, Standing, Survey, survey};

/// Largest number of assignments that are played, unless another limit is given.
pub const DEFAULT_LIMIT: u64 = 1_000;

/// The limits that can be asked for. All assignments are in memory at once.
pub const LIMITS: RangeInclusive<u64> = 2..=1_000_000;
