//! The policies, the estimators and the protocols of the house, one file each, with their options. They
//! answer the questions of [`teaming`].
//!
//! ```
//! let rne = policies::standard().make("RNE", "(score: Sum)")?;
//! assert!(rne.options.contains("score: Sum, "));
//! # Ok::<(), teaming::RegistryError>(())
//! ```
//!
//! A policy is one file and one line in [`standard`], and so is a trust measure; an estimator is one file and
//! one line in [`estimators`]; a protocol is a file in `protocols`. A program adds its own with
//! [`Registry::add`], [`Registry::add_measure`], [`Registry::add_estimator`] and [`Registry::add_protocol`].

mod assigning;
pub mod balance;
pub mod bandit;
mod clustering;
pub mod distance;
pub mod energy;
pub mod estimators;
mod facts;
pub mod grape;
pub mod greedy;
pub mod hp_distance;
pub mod kmeans;
pub mod optimal;
mod protocols;
pub mod random;
mod ranking;
pub mod rne;
mod searching;
pub mod similar;
pub mod snake;
pub mod spectral;
pub mod utility;

use teaming::Registry;

pub use rne::RneOptions;

/// The built-in policies, estimators and protocols, and RNE as a trust measure.
#[must_use]
pub fn standard() -> Registry {
    let mut registry = Registry::default();
    let first = [rne::kind(), distance::kind(), energy::kind(), hp_distance::kind(), random::kind()];
    let of_utility = [optimal::kind(), greedy::kind(), grape::kind()];
    let of_strength = [snake::kind(), balance::kind(), similar::kind(), kmeans::kind(), spectral::kind()];
    for kind in first.into_iter().chain(of_utility).chain(of_strength).chain([bandit::kind()]) {
        let _ = registry.add(kind); // their names differ
    }
    let _ = registry.add_measure(rne::measure_kind());
    for kind in estimators::kinds() {
        let _ = registry.add_estimator(kind); // so do theirs
    }
    for kind in protocols::kinds() {
        let _ = registry.add_protocol(kind); // and theirs
    }
    registry
}

/// The README's example is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod made_up;

#[cfg(test)]
mod tests {
    use teaming::RegistryError;
    use teaming::registry_error::Entry;

    use super::*;

    #[test]
    fn an_unknown_policy_lists_the_known_ones() {
        let error = standard().make("NEAREST", "").unwrap_err();
        assert_eq!(
            error.to_string(),
            "unknown policy \"NEAREST\"; known policies: RNE, DIS, ENG, HP_DIS, RANDOM, OPTIMAL, GREEDY, \
             GRAPE, SNAKE, BALANCE, SIMILAR, KMEANS, SPECTRAL, BANDIT"
        );
    }

    #[test]
    fn options_are_read_written_in_full_and_refused_with_the_known_ones() {
        let registry = standard();
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
        let mut registry = standard();
        let error = registry.add(random::kind()).unwrap_err();
        assert_eq!(error, RegistryError::DuplicateName { entry: Entry::Policy, name: "RANDOM".into() });
    }
}
