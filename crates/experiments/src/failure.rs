//! Why something ended without its result.

use thiserror::Error;

/// What went wrong, with the sentence for the user.
#[derive(Debug, Error)]
pub enum Failure {
    /// What was given cannot be used. Nothing was written.
    #[error("{0}")]
    Input(String),
    /// It went wrong underway.
    #[error("{0}")]
    Run(String),
    /// The disk or folder does not do what is needed. What was finished is kept.
    #[error("{0}")]
    Storage(String),
    /// The user stopped it.
    #[error("{0}")]
    Interrupted(String),
    /// The reader of our output went away (`usar ... | head`): nothing is to be said.
    #[error("output closed")]
    ClosedOutput,
}

impl Failure {
    /// Bad input, from anything that says what is wrong.
    pub fn input(message: impl std::fmt::Display) -> Self {
        Self::Input(message.to_string())
    }

    /// Trouble with a disk or folder.
    pub fn storage(message: impl std::fmt::Display) -> Self {
        Self::Storage(message.to_string())
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
            Self::Storage(format!("cannot write: {error}"))
        }
    }
}

/// What a panic said.
#[must_use]
pub fn panic_message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("a defect without a message").to_owned()
}
