//! The registry: policies by name, each with its options. It is a value: whoever has one adds kinds with
//! [`Registry::add`].

use std::fmt;
use std::sync::Arc;

use crate::error::RegistryError;
use crate::kind::PolicyKind;
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
