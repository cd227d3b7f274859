//! How good single decisions were: outcomes of other assignments on disk, and the study of regret.

mod log;

pub use log::{DecisionKey, OutcomeLog};
