//! Errors of registries: a name or options that cannot be made into something.

use std::fmt;

use thiserror::Error;

use crate::error::PolicyError;

/// A policy, trust measure, estimator or protocol that cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum RegistryError {
    /// No entry of that name.
    #[error("unknown {entry} {found:?}; known {}: {}{}", entry.many(), known.join(", "), meant(found, known))]
    Unknown {
        /// What was asked for.
        entry: Entry,
        /// The name that was asked for.
        found: String,
        /// All names of the registry.
        known: Vec<String>,
    },
    /// A name that is already in the registry.
    #[error("{entry} {name:?} is in the registry already")]
    DuplicateName {
        /// What was to be added.
        entry: Entry,
        /// The name.
        name: String,
    },
    /// Options that there are not, or values that they cannot take.
    #[error("{entry} {name}: {reason}{}", known_options(options))]
    Options {
        /// What was asked for.
        entry: Entry,
        /// Its name.
        name: String,
        /// What is wrong, and the options as given.
        reason: String,
        /// The options with their defaults.
        options: String,
    },
    /// What stands behind the arrow of a policy, or behind `by`, is wrong.
    #[error("{text}: {reason}")]
    Arrow {
        /// The policy as it was written.
        text: String,
        /// The rule, and what was found.
        reason: String,
    },
    /// A policy whose session cannot be opened.
    #[error("policy {policy}: {source}")]
    Open {
        /// Name of the policy.
        policy: String,
        /// Why.
        source: PolicyError,
    },
}

/// What a registry has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Entry {
    /// A policy.
    Policy,
    /// A trust measure.
    TrustMeasure,
    /// An estimator.
    Estimator,
    /// A protocol.
    Protocol,
}

impl Entry {
    fn many(self) -> &'static str {
        match self {
            Self::Policy => "policies",
            Self::TrustMeasure => "trust measures",
            Self::Estimator => "estimators",
            Self::Protocol => "protocols",
        }
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Policy => "policy",
            Self::TrustMeasure => "trust measure",
            Self::Estimator => "estimator",
            Self::Protocol => "protocol",
        })
    }
}

fn meant(found: &str, known: &[String]) -> String {
    let meant = ron_tree::nearest(found, known.iter().map(String::as_str));
    meant.map(|meant| format!("; did you mean {meant}?")).unwrap_or_default()
}

fn known_options(options: &str) -> String {
    if options.is_empty() { String::new() } else { format!("; options and defaults: {options}") }
}
