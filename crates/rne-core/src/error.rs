//! Errors of the trust maths and of the grouping policies: one sentence each, for the person who can fix the input.

use thiserror::Error;

/// A needs table, weight vector or distribution that the maths is not defined for.
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

/// A team that a policy cannot group, or a policy that does not exist.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum GroupingError {
    /// No policy of that name.
    #[error("unknown policy {found:?}; known policies: {}", known.join(", "))]
    UnknownPolicy {
        /// The name that was asked for.
        found: String,
        /// All names of the registry.
        known: Vec<&'static str>,
    },
    /// The same id twice.
    #[error("robot id {id} stands twice in the team; ids must be unique")]
    DuplicateId {
        /// The id.
        id: u32,
    },
    /// The policy needs a fact that the team does not carry.
    #[error("policy {policy} needs {what}, which is missing{}", robot.map(|id| format!(" for robot {id}")).unwrap_or_default())]
    MissingFact {
        /// Name of the policy.
        policy: &'static str,
        /// The fact ("the energy level", ...).
        what: &'static str,
        /// The robot without it, where it is one robot's.
        robot: Option<u32>,
    },
    /// A fact that must be a finite number is not.
    #[error("{what} of robot {id} must be a finite number, found {found}")]
    NotFinite {
        /// The fact.
        what: &'static str,
        /// The robot.
        id: u32,
        /// The value.
        found: f64,
    },
    /// A robot's needs cannot be used.
    #[error("robot {id}: {source}")]
    Needs {
        /// The robot.
        id: u32,
        /// What is wrong with its needs.
        source: NeedsError,
    },
    /// The options of the policy cannot be used.
    #[error("options of the policy: {0}")]
    Options(NeedsError),
}
