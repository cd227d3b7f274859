//! The one list of policies. A policy is one file and one line here.

use super::GroupingPolicy;
use super::distance::Distance;
use super::energy::Energy;
use super::hp_distance::HpDistance;
use super::random::Random;
use super::rne::{Rne, RneOptions};
use crate::error::GroupingError;

type Make = fn(&RneOptions) -> Result<Box<dyn GroupingPolicy>, GroupingError>;

const POLICIES: &[(&str, Make)] = &[
    ("RNE", |options| Ok(Box::new(Rne::new(options.clone())?))),
    ("DIS", |_| Ok(Box::new(Distance))),
    ("ENG", |_| Ok(Box::new(Energy))),
    ("HP_DIS", |_| Ok(Box::new(HpDistance))),
    ("RANDOM", |_| Ok(Box::new(Random))),
];

/// The names of all policies.
#[must_use]
pub fn policy_names() -> Vec<&'static str> {
    POLICIES.iter().map(|(name, _)| *name).collect()
}

/// Makes the policy of that name; `options` matter to the RNE policy alone.
///
/// # Errors
/// An unknown name, with the list of the known ones; or options that cannot be used.
pub fn policy_named(name: &str, options: &RneOptions) -> Result<Box<dyn GroupingPolicy>, GroupingError> {
    match POLICIES.iter().find(|(known, _)| *known == name) {
        Some((_, make)) => make(options),
        None => Err(GroupingError::UnknownPolicy { found: name.to_owned(), known: policy_names() }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_policy_answers_to_its_own_name() {
        for name in policy_names() {
            assert_eq!(policy_named(name, &RneOptions::default()).unwrap().name(), name);
        }
    }

    #[test]
    fn an_unknown_policy_lists_the_known_ones() {
        let error = policy_named("NEAREST", &RneOptions::default()).err().unwrap();
        assert_eq!(
            error.to_string(),
            "unknown policy \"NEAREST\"; known policies: RNE, DIS, ENG, HP_DIS, RANDOM"
        );
    }
}
