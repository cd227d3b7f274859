//! Why a candidate of a calibration cannot be run.

use experiments::explore::PointError;
use rne_core::RegistryError;
use thiserror::Error;

/// Why a candidate of a calibration cannot be run.
#[derive(Debug, Error)]
pub enum CandidateError {
    /// Its values make no scenario.
    #[error(transparent)]
    Values(#[from] PointError),
    /// The policy cannot be made.
    #[error(transparent)]
    Policy(#[from] RegistryError),
    /// A trial failed.
    #[error("{reason}")]
    Trial {
        /// Why it failed.
        reason: String,
    },
    /// A trial panicked.
    #[error("internal error: {message}")]
    Internal {
        /// The message of the panic.
        message: String,
    },
    /// A quantity of the target is undefined in a trial.
    #[error("{quantity} is not defined in a trial")]
    Undefined {
        /// Name of the quantity.
        quantity: String,
    },
}
