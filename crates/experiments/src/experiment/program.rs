//! The program that made results: its version and hashes of its sources, policy by policy.

use std::sync::OnceLock;

use rne_core::MadePolicy;
use xxhash_rust::xxh3::xxh3_64;

use super::policy::PolicySpec;
use crate::failure::Failure;
use crate::oracle::NotSimulated;

/// The sources of this program that decide numbers, as a whole.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Build {
    /// Version of the program.
    pub version: String,
    /// Hash of the sources of the simulator, the laboratory and all built-in policies.
    pub source: String,
}

impl Build {
    /// The build that runs now.
    #[must_use]
    pub fn this() -> Self {
        Self { version: env!("CARGO_PKG_VERSION").to_owned(), source: env!("USAR_SOURCE").to_owned() }
    }
}

/// The program as far as it decides the trials of a sweep. A policy's trials stay valid as long as the
/// simulator and the policy's own sources stay the same.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Program {
    /// Version of the program.
    pub version: String,
    /// Hash of the sources that decide every trial: all but those of the policies.
    pub source: String,
    /// Hash of the sources of each policy of the sweep. Empty for results of layouts before 6, whose
    /// `source` covers the policies.
    pub policies: Vec<String>,
}

impl Program {
    /// The program that runs now, with these policies.
    ///
    /// # Errors
    /// A policy is of another crate, and the file of the running program cannot be read.
    pub fn running(policies: &[PolicySpec]) -> Result<Self, Failure> {
        let policies = policies.iter().map(|spec| source_of(spec.made())).collect::<Result<_, _>>()?;
        let version = env!("CARGO_PKG_VERSION").to_owned();
        Ok(Self { version, source: env!("USAR_ENGINE").to_owned(), policies })
    }

    /// What decides the trials of the policy with this number, as text.
    pub(super) fn deciding(&self, policy: usize) -> String {
        let Self { version, source, policies } = self;
        let own = policies.get(policy).map_or(String::new(), |own| format!(" {own}"));
        format!("Program {{ version: {version:?}, source: {source:?} }}{own}")
    }
}

/// Hash of the sources that decide a policy's answers besides the simulator. The oracle plays trials on with
/// any policy, so that it has the hash of all. For a policy of another crate it is a hash of the running
/// program.
fn source_of(policy: &MadePolicy) -> Result<String, Failure> {
    if policy.name == NotSimulated::NAME {
        return Ok(env!("USAR_SOURCE").to_owned());
    }
    let file = policy.file.replace('\\', "/");
    let own = file.split_once("crates/policies/src/").and_then(|(_, rest)| rest.split('/').next());
    let built_in = env!("USAR_POLICIES").split(';').filter_map(|entry| entry.split_once('='));
    let found = built_in.into_iter().find(|(name, _)| Some(*name) == own);
    found.map_or_else(executable, |(_, hash)| Ok(hash.to_owned()))
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
    fn a_policy_of_another_crate_has_the_hash_of_the_program_that_has_it() {
        let mut policy = PolicySpec::parse("DIS", &policies::standard()).unwrap().made().clone();
        policy.file = "src/main.rs";
        let program = std::fs::read(std::env::current_exe().unwrap()).unwrap();
        assert!(program.len() > 1 << 20);
        assert_eq!(source_of(&policy).unwrap(), format!("{:016x}", xxh3_64(&program)));
    }
}
