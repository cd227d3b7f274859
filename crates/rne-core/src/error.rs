//! Errors of the trust maths: one sentence each, for the person who can fix the input.

use thiserror::Error;

/// A needs table, weight vector or distribution for which the mathematics is not defined.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NeedsError {
    /// A vector without entries.
    #[error("{what} must have at least one entry, found none")]
    Empty {
        /// What was given ("needs", "weights", ...).
        what: &'static str,
    },
    /// A NaN, infinite or negative entry.
    #[error("{what}[{index}] must be a finite number >= 0, found {found}")]
    OutOfRange {
        /// What was given.
        what: &'static str,
        /// Position of the entry, from 0.
        index: usize,
        /// The entry.
        found: f64,
    },
    /// All entries are zero, so that no distribution exists.
    #[error("{what} must have at least one entry above 0, found only zeros")]
    AllZero {
        /// What was given.
        what: &'static str,
    },
    /// Two vectors that must have the same length differ.
    #[error("{what} must have {expected} entries, found {found}")]
    Length {
        /// What was given.
        what: &'static str,
        /// Length that was needed.
        expected: usize,
        /// Length that was found.
        found: usize,
    },
    /// Entries so large or so small that their weighted sum is not a normal number.
    #[error("the weighted needs add up to {found}, which no distribution can be made of; rescale them")]
    Overflow {
        /// The sum.
        found: f64,
    },
    /// Entries of a distribution that do not add up to 1.
    #[error("{what} must add up to 1, found {found}")]
    NotNormalised {
        /// What was given.
        what: &'static str,
        /// The sum.
        found: f64,
    },
}
