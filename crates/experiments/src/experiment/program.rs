//! The program that made results: its version and hashes of its sources, policy by policy.

use std::fmt;
use std::sync::OnceLock;

use store::Failure;
use teaming::MadePolicy;
use usar_sim::BITS;
use xxhash_rust::xxh3::xxh3_64;

use super::policy::PolicySpec;

/// Hash of the sources that decide every trial: all but those of the policies.
pub const SOURCE: &str = env!("USAR_ENGINE");

/// The program as far as it decides the trials of a sweep. A policy's trials stay valid as long as the bits
/// and the policy's own sources stay the same.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Program {
    /// Version of the program.
    pub version: String,
    /// Hash of the sources that decide every trial: all but those of the policies.
    pub source: String,
    /// Number of the bits: see [`BITS`].
    pub bits: u32,
    /// Hash of the sources of each policy of the sweep.
    pub policies: Vec<String>,
}

/// A program in short: trials of programs with the same digest are the same.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Digest {
    /// Number of the bits: see [`BITS`].
    pub bits: u32,
    /// Hash of the sources of the policies.
    pub policies: String,
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "bits {}, policies {}", self.bits, self.policies)
    }
}

impl Program {
    /// The program that runs now, with these policies.
    ///
    /// # Errors
    /// A policy is of another crate, and the file of the running program cannot be read.
    pub fn running(policies: &[PolicySpec]) -> Result<Self, Failure> {
        let policies = policies.iter().map(|spec| source_of(spec.made())).collect::<Result<_, _>>()?;
        let version = env!("CARGO_PKG_VERSION").to_owned();
        Ok(Self { version, source: SOURCE.to_owned(), bits: BITS, policies })
    }

    /// The bits, and one hash of the sources of these policies.
    pub fn digest(&self) -> Digest {
        let policies = format!("{:016x}", xxh3_64(self.policies.join(" ").as_bytes()));
        Digest { bits: self.bits, policies }
    }

    /// What decides the trials of the policy with this number, as text.
    pub(super) fn deciding(&self, policy: usize) -> String {
        format!("bits {} {}", self.bits, self.policies.get(policy).map_or("", String::as_str))
    }
}

/// What decides a policy's answers besides the simulator: its own fingerprint, or else a hash of the running
/// program.
fn source_of(policy: &MadePolicy) -> Result<String, Failure> {
    policy.fingerprint().map_or_else(executable, Ok)
}

/// Hash of the running program's file.
fn executable() -> Result<String, Failure> {
    static HASH: OnceLock<Result<String, String>> = OnceLock::new();
    let hash = HASH.get_or_init(|| {
        let file = std::env::current_exe().and_then(std::fs::read).map_err(|error| error.to_string())?;
        Ok(format!("{:016x}", xxh3_64(&file)))
    });
    hash.clone().map_err(|error| {
        Failure::storage(format!(
            "the file of this program, by which results know a policy of another crate, cannot be read: \
             {error}"
        ))
    })
}

#[cfg(test)]
mod tests {
    use teaming::{Decision, Policy, PolicyError, PolicyKind, Question};

    use super::*;
    use crate::experiment::with_oracle;

    fn source(text: &str) -> String {
        source_of(PolicySpec::parse(text, &with_oracle(policies::standard())).unwrap().made()).unwrap()
    }

    #[test]
    fn each_built_in_policy_has_sources_of_its_own() {
        let names = ["RNE", "DIS", "ENG", "HP_DIS", "RANDOM", "ORACLE"];
        let mut sources: Vec<String> = names.map(source).to_vec();
        assert!(!sources.contains(&executable().unwrap()));
        assert_eq!(source("RNE(score: Sum)"), sources[0]);
        sources.sort();
        sources.dedup();
        assert_eq!(sources.len(), names.len());
    }

    #[test]
    fn an_oracle_is_known_by_the_policy_that_goes_on() {
        assert_eq!(source("ORACLE(limit: 5)"), source("ORACLE"));
        let onwards = |policy: &str| source(&format!("ORACLE(horizon: Trial, then: {policy:?})"));
        assert_eq!(onwards("DIS"), format!("oracle {}", source("DIS")));
        assert_ne!(onwards("DIS"), onwards("ENG"));
    }

    #[test]
    fn a_policy_without_a_hash_of_its_sources_has_that_of_the_program() {
        #[derive(Clone)]
        struct Nobody;
        impl Policy for Nobody {
            fn decide(&self, _: &Question) -> Result<Decision, PolicyError> {
                Err(PolicyError::Late)
            }
        }
        let mut registry = policies::standard();
        registry.add(PolicyKind::plain("NOBODY", "never answers", Nobody)).unwrap();
        let program = std::fs::read(std::env::current_exe().unwrap()).unwrap();
        assert!(program.len() > 1 << 20);
        let policy = registry.parse("NOBODY").unwrap();
        assert_eq!(source_of(&policy).unwrap(), format!("{:016x}", xxh3_64(&program)));
    }
}
