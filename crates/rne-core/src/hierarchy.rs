//! The robot needs hierarchy (paper: Section II-B, Eqs. 3 to 6): expectations of safety, basic, capability
//! and teaming needs. A level counts only if the levels below it are met.
//!
//! No source publishes the probabilities; [`PerceivedNeed::certain`] sets them to 1.

use serde::{Deserialize, Serialize};

use crate::error::NeedsError;
use crate::needs::{check_entries, check_probabilities};

/// The four levels, lowest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum NeedLevel {
    /// Health, speed and sensing range (Eq. 3).
    Safety,
    /// Energy (Eq. 4).
    Basic,
    /// Resources, capacity and observing range (Eq. 5).
    Capability,
    /// The group's utility, here the number of rescuees (Eq. 6).
    Teaming,
}

impl NeedLevel {
    /// All levels, lowest first.
    pub const ALL: [Self; 4] = [Self::Safety, Self::Basic, Self::Capability, Self::Teaming];
}

/// One need as a robot perceives it: a summand of one of Eqs. 3 to 6.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PerceivedNeed {
    /// The level that it belongs to.
    pub level: NeedLevel,
    /// Weight `W_i`, capability level `A_i` or utility `U_i`; finite and >= 0.
    pub weight: f64,
    /// Probability in [0, 1] that the need is met, given what is perceived and heard and the level below.
    pub probability: f64,
}

impl PerceivedNeed {
    /// A need that is met for certain: the default where nothing is known about its probability.
    #[must_use]
    pub fn certain(level: NeedLevel, weight: f64) -> Self {
        Self { level, weight, probability: 1.0 }
    }
}

/// Needs expectation of each level, `sum_i w_i p_i` (Eqs. 3 to 6), lowest level first. `None` if a level
/// below is not met, so that the level does not count. A level is met if its expectation is at least
/// `required_share` (in [0, 1]) of its value under certainty. A level without needs is met.
///
/// # Errors
/// A weight that is NaN, infinite or negative; a probability or `required_share` outside [0, 1].
pub fn expectations(needs: &[PerceivedNeed], required_share: f64) -> Result<[Option<f64>; 4], NeedsError> {
    let weights: Vec<f64> = needs.iter().map(|need| need.weight).collect();
    let probabilities: Vec<f64> = needs.iter().map(|need| need.probability).collect();
    check_entries("weights", &weights)?;
    check_probabilities(&probabilities)?;
    check_probabilities(&[required_share])?;

    let mut expected = [None; 4];
    for (slot, level) in expected.iter_mut().zip(NeedLevel::ALL) {
        let of_level = || needs.iter().filter(move |need| need.level == level);
        let expectation: f64 = of_level().map(|need| need.weight * need.probability).sum();
        let certain: f64 = of_level().map(|need| need.weight).sum();
        if !certain.is_finite() {
            return Err(NeedsError::Overflow { found: certain });
        }
        *slot = Some(expectation);
        if expectation < required_share * certain {
            break;
        }
    }
    Ok(expected)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn need(level: NeedLevel, weight: f64, probability: f64) -> PerceivedNeed {
        PerceivedNeed { level, weight, probability }
    }

    #[test]
    fn certain_needs_are_expected_in_full() {
        let needs = [
            PerceivedNeed::certain(NeedLevel::Safety, 90.0),
            PerceivedNeed::certain(NeedLevel::Basic, 80.0),
            PerceivedNeed::certain(NeedLevel::Capability, 6.0),
            PerceivedNeed::certain(NeedLevel::Capability, 1.0),
            PerceivedNeed::certain(NeedLevel::Teaming, 20.0),
        ];
        assert_eq!(expectations(&needs, 1.0).unwrap(), [Some(90.0), Some(80.0), Some(7.0), Some(20.0)]);
    }

    #[test]
    fn a_level_does_not_count_when_the_one_below_is_not_met() {
        let needs = [
            need(NeedLevel::Safety, 100.0, 0.9),
            need(NeedLevel::Basic, 100.0, 0.2),
            need(NeedLevel::Capability, 6.0, 1.0),
            need(NeedLevel::Teaming, 20.0, 1.0),
        ];
        assert_eq!(expectations(&needs, 0.3).unwrap(), [Some(90.0), Some(20.0), None, None]);
    }

    #[test]
    fn impossible_probabilities_are_refused() {
        assert!(expectations(&[need(NeedLevel::Safety, 1.0, 1.2)], 0.5).is_err());
        assert!(expectations(&[need(NeedLevel::Safety, f64::NAN, 1.0)], 0.5).is_err());
        assert!(expectations(&[need(NeedLevel::Safety, 1.0, 1.0)], f64::NAN).is_err());
    }
}
