//! What lies cost each policy of a sweep: its room among honest robots, how many liars it bears, what an
//! estimator costs where nobody lies, and how well estimators judge.
//!
//! The sweep has an axis of who lies, `[Count(0), Count(1), ...]`. All other axes together are the lie, or
//! the world. The metric, its margin and the fair draw are those that the sweep file names.

mod borne;
mod cells;

pub use borne::{ACCURACY, Borne, Deceit, Judgement, Price};
pub use cells::Difference;
