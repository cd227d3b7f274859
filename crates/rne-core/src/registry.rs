//! The registry: policies by name, each with its options. A built-in policy is one file and one line in
//! [`Registry::standard`]; a program that uses this crate adds its own with [`Registry::add`].

use std::fmt;
use std::sync::Arc;

use crate::error::RegistryError;
use crate::kind::PolicyKind;
use crate::policies::{distance, energy, hp_distance, random, rne};
use crate::policy::Policy;

/// Policies by name.
#[derive(Debug, Clone, Default)]
pub struct Registry {
    kinds: Vec<PolicyKind>,
}

/// A policy as it was requested.
#[derive(Clone)]
pub struct MadePolicy {
    /// Its name.
    pub name: String,
    /// All its options in RON, including the defaults. Policies with the same name and options give the same
    /// answers. Empty for a policy without options.
    pub options: String,
    /// See [`PolicyKind::file`].
    pub file: &'static str,
    /// The policy.
    pub policy: Arc<dyn Policy>,
}

impl fmt::Debug for MadePolicy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.name, self.options)
    }
}

impl Registry {
    /// The built-in policies.
    #[must_use]
    pub fn standard() -> Self {
        Self {
            kinds: vec![rne::kind(), distance::kind(), energy::kind(), hp_distance::kind(), random::kind()],
        }
    }

    /// Adds a policy.
    ///
    /// # Errors
    /// The name is taken.
    pub fn add(&mut self, kind: PolicyKind) -> Result<(), RegistryError> {
        if self.kinds.iter().any(|known| known.name == kind.name) {
            return Err(RegistryError::DuplicateName { name: kind.name });
        }
        self.kinds.push(kind);
        Ok(())
    }

    /// All kinds, in the order in which they were added.
    #[must_use]
    pub fn kinds(&self) -> &[PolicyKind] {
        &self.kinds
    }

    /// The names of all policies.
    #[must_use]
    pub fn names(&self) -> Vec<&str> {
        self.kinds.iter().map(|kind| kind.name.as_str()).collect()
    }

    /// Makes a policy from its name and its options in RON, such as `(score: Sum)`; empty for the defaults.
    ///
    /// ```
    /// let rne = rne_core::Registry::standard().make("RNE", "(score: Sum)")?;
    /// assert!(rne.options.contains("score: Sum, "));
    /// # Ok::<(), rne_core::RegistryError>(())
    /// ```
    ///
    /// # Errors
    /// An unknown name, with the known names; or options that the policy does not have or cannot use, with
    /// the options that it has.
    pub fn make(&self, name: &str, options: &str) -> Result<MadePolicy, RegistryError> {
        let kind = self.kinds.iter().find(|kind| kind.name == name).ok_or_else(|| {
            let known = self.names().into_iter().map(str::to_owned).collect();
            RegistryError::UnknownPolicy { found: name.to_owned(), known }
        })?;
        let (policy, all) = (kind.make)(options).map_err(|reason| RegistryError::Options {
            policy: name.to_owned(),
            reason,
            found: options.trim().to_owned(),
            options: kind.defaults.clone(),
        })?;
        Ok(MadePolicy { name: name.to_owned(), options: all, file: kind.file, policy })
    }

    /// Makes a policy from one text: `DIS`, `RNE(score: Sum)`.
    ///
    /// # Errors
    /// Those of [`Registry::make`].
    pub fn parse(&self, text: &str) -> Result<MadePolicy, RegistryError> {
        let text = text.trim();
        let (name, options) = text.split_at(text.find('(').unwrap_or(text.len()));
        self.make(name.trim(), options)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_policy_lists_the_known_ones() {
        let error = Registry::standard().make("NEAREST", "").unwrap_err();
        assert_eq!(
            error.to_string(),
            "unknown policy \"NEAREST\"; known policies: RNE, DIS, ENG, HP_DIS, RANDOM"
        );
    }

    #[test]
    fn options_are_read_written_in_full_and_refused_with_the_known_ones() {
        let registry = Registry::standard();
        let made = registry.parse("RNE( weights: [1, 2], sort: true )").unwrap();
        assert_eq!(
            made.options,
            "(log_base: E, sort: true, score: MaxOfBoth, weights: [1.0, 2.0], scale: true, \
             merge: Apart, hard_rule: IntraGroupTrust)"
        );
        assert_eq!(registry.parse(&format!("RNE{}", made.options)).unwrap().options, made.options);
        let refused = |text| registry.parse(text).unwrap_err().to_string();
        assert_eq!(refused("DIS(score: Sum)"), "policy DIS: it has no options, found \"(score: Sum)\"");
        let error = refused("RNE(scale: 3)");
        assert!(
            error.contains("policy RNE: ") && error.contains("options and defaults: (log_base: E"),
            "{error}"
        );
        assert!(refused("RNE(weights: [-1.0])").contains("weights[0] must be a finite number >= 0"));
        assert!(refused("RNE(sort: true").contains("policy RNE: "));
    }

    #[test]
    fn a_name_can_be_taken_only_once() {
        let mut registry = Registry::standard();
        let error = registry.add(random::kind()).unwrap_err();
        assert_eq!(error, RegistryError::DuplicateName { name: "RANDOM".into() });
    }
}
