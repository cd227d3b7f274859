//! Why a command ended without its result.

use thiserror::Error;

/// A command that failed, with the sentence for its user.
#[derive(Debug, Error)]
pub enum Failure {
    /// What was given cannot be used: exit status 2, nothing was written.
    #[error("{0}")]
    Input(String),
    /// It went wrong underway: exit status 1.
    #[error("{0}")]
    Run(String),
    /// The reader of our output went away (`usar ... | head`): no message, exit status 0.
    #[error("output closed")]
    ClosedOutput,
}

impl Failure {
    /// Bad input, from anything that says what is wrong.
    pub fn input(message: impl std::fmt::Display) -> Self {
        Self::Input(message.to_string())
    }

    /// Trouble underway.
    pub fn run(message: impl std::fmt::Display) -> Self {
        Self::Run(message.to_string())
    }
}

impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        if error.kind() == std::io::ErrorKind::BrokenPipe {
            Self::ClosedOutput
        } else {
            Self::Run(format!("cannot write: {error}"))
        }
    }
}
