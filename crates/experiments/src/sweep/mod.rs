//! Many trials: which ones, on which threads, what became of them, and where they are kept.

pub mod disk;
mod file;
pub mod folder;
mod journal;
pub mod links;
mod pool;
mod rows;
mod shared;
mod table;
mod tables;
mod trial;

pub use file::FileHash;
pub(crate) use file::NewFile;
pub use journal::Place;
pub use pool::{Limits, Run, run_all};
pub(crate) use rows::trial_columns;
pub use shared::SharedTrials;
pub use trial::{Fault, FaultKind, Grouped, Outcome, Trial, TrialKey, run_trial, series_times};
