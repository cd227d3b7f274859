//! The error for a value on the command line.

use thiserror::Error;

/// A value on the command line that its flag does not take.
#[derive(Debug, PartialEq, Eq, Error)]
#[error("must be {rule}, found {found:?}")]
pub struct BadValue {
    rule: &'static str,
    found: String,
}

impl BadValue {
    /// The error for this text.
    pub fn new(rule: &'static str, found: &str) -> Self {
        Self { rule, found: found.to_owned() }
    }
}
