//! Why something ended without its result.

use std::cell::RefCell;

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

thread_local! {
    /// Where this thread panicked last.
    static PLACE: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// From now on, a panic prints nothing, and [`panic_message`] says where it was.
pub fn catch_panics_quietly() {
    std::panic::set_hook(Box::new(|panic| {
        let place = panic.location().map(|place| format!("{}:{}", from_sources(place.file()), place.line()));
        PLACE.set(place);
    }));
}

/// The path of a source, of a library's from the library's name on.
fn from_sources(path: &str) -> &str {
    let Some((_, rest)) = path.split_once("registry/src/") else { return path };
    rest.split_once('/').map_or(rest, |(_, rest)| rest)
}

/// What a panic that this thread caught said, with its file and line where [`catch_panics_quietly`] was called.
#[must_use]
pub fn panic_message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("a defect without a message");
    let place = PLACE.take().map_or(String::new(), |place| format!(" ({place})"));
    format!("{text}{place}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_of_libraries_are_named_without_the_machines_folders() {
        let path = "/home/x/.cargo/registry/src/index.crates.io-1/parry2d-0.31.1/src/lib.rs";
        assert_eq!(from_sources(path), "parry2d-0.31.1/src/lib.rs");
        assert_eq!(from_sources("crates/usar/src/lib.rs"), "crates/usar/src/lib.rs");
    }
}
