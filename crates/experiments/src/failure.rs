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
    /// The disk or folder does not do what is needed: exit status 3. What was finished is kept.
    #[error("{0}")]
    Storage(String),
    /// The user stopped it: exit status 130.
    #[error("{0}")]
    Interrupted(String),
    /// The reader of our output went away (`usar ... | head`): no message, exit status 0.
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

    /// The exit status of the process.
    #[must_use]
    pub fn exit_status(&self) -> u8 {
        match self {
            Self::ClosedOutput => 0,
            Self::Run(_) => 1,
            Self::Input(_) => 2,
            Self::Storage(_) => 3,
            Self::Interrupted(_) => 130,
        }
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
pub(crate) fn panic_message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("a defect without a message").to_owned()
}
