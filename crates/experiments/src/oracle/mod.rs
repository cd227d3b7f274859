//! What would have come of every other assignment: each one is played in the trial that asks, with the same
//! random streams.
//!
//! The paper's team of six carriers, four suppliers and two observers has 240 assignments over two tasks.
//! The best of them is what a policy with perfect foresight would choose; the *regret* of a decision is how
//! far it stays behind. Robots of one role differ at least in where they are, so that none is exchangeable
//! for another and every assignment is played.

mod branch;
mod decider;
mod objective;
mod survey;

pub use branch::{Branch, BranchError, Outcome, advance_to, play};
pub use decider::{Horizon, NotSimulated, Oracle, OracleOptions};
pub use objective::{Objective, UnknownObjective};
pub use survey::{Coverage, Evaluation, Standing, Survey, survey};

/// Assignments that are played, unless another limit is asked for.
pub const DEFAULT_LIMIT: u64 = 1_000;
