//! Trials: one, those that policies share, and many of them on threads. It knows nothing of where results are kept.

mod driver;
mod pool;
mod shared;
mod trial;

pub use driver::Driver;
pub use pool::{Limits, Run, run_all, run_batches};
pub use shared::SharedTrials;
pub use trial::{Fault, FaultKind, Outcome, Trial, TrialKey, run_trial, series_times};
