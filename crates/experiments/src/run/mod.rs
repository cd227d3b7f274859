//! Running trials: a single trial, trials that policies share, and many trials on threads. This module does
//! not know where results are stored.

mod pool;
mod sessions;
mod shared;
mod trial;

pub use pool::{Limits, Run, run_all, run_batches};
pub use sessions::{Player, Sessions};
pub use shared::SharedTrials;
pub use trial::{Fault, FaultKind, Outcome, Trial, TrialKey, TrialSetup, run_trial, series_times};
