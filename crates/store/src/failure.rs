//! Why a command ended without its result.

use std::io::{Error, ErrorKind};
use std::path::Path;

use thiserror::Error;

/// A failure, with the message for the user.
#[derive(Debug, Error)]
pub enum Failure {
    /// The input cannot be used. Nothing was written.
    #[error("{0}")]
    Input(Box<dyn std::error::Error + Send + Sync>),
    /// The run failed.
    #[error("{0}")]
    Run(String),
    /// The disk or folder refused an operation. Finished results are kept.
    #[error("{0}")]
    Storage(String),
    /// The user interrupted it.
    #[error("{0}")]
    Interrupted(String),
    /// The reader of our output closed it (`usar ... | head`). No message is printed.
    #[error("output closed")]
    ClosedOutput,
}

impl Failure {
    /// A failure because of bad input.
    pub fn input(cause: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> Self {
        Self::Input(cause.into())
    }

    /// Makes the failure of an option or a file from what is wrong with it.
    pub fn input_at<E: std::fmt::Display>(place: impl std::fmt::Display) -> impl Fn(E) -> Self {
        move |error| Self::input(format!("{place}: {error}"))
    }

    /// A failure of a disk or folder.
    pub fn storage(message: impl std::fmt::Display) -> Self {
        Self::Storage(message.to_string())
    }

    /// A failure of the run.
    pub fn run(message: impl std::fmt::Display) -> Self {
        Self::Run(message.to_string())
    }
}

/// Returns from a function because of bad input, with a message that is written as for `format!`.
#[macro_export]
macro_rules! refuse {
    ($($message:tt)+) => {
        return Err($crate::Failure::input(format!($($message)+)))
    };
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        if error.kind() == ErrorKind::BrokenPipe {
            Self::ClosedOutput
        } else {
            Self::Storage(format!("cannot write: {error}"))
        }
    }
}

/// Makes the failure of a file or folder from what the system says of it.
pub fn at(path: &Path) -> impl Fn(Error) -> Failure {
    move |error| Failure::Storage(format!("{}: {error}", path.display()))
}
