//! Needs vectors, weights and the distributions made of them (paper: Section III, Eqs. 8 and 9).

use serde::{Deserialize, Serialize};

use crate::error::NeedsError;

/// The current state of one robot's needs: any number (>= 1) of finite values >= 0, each in a unit of its
/// own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(try_from = "Vec<f64>")]
pub struct NeedVector(Vec<f64>);

/// The weight of each need: finite values >= 0, at least one above 0. Only their ratios matter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NeedWeights(Vec<f64>);

/// Shares of the needs of one robot or group: values in [0, 1] that add up to 1.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NeedDistribution(Vec<f64>);

impl NeedVector {
    /// Takes the values as they are.
    ///
    /// # Errors
    /// No entry, or an entry that is NaN, infinite or negative.
    pub fn new(values: Vec<f64>) -> Result<Self, NeedsError> {
        check_entries("needs", &values)?;
        Ok(Self(values))
    }

    /// The state, weighted by the probability that each need is met (the summands of Eqs. 3 to 5). With all
    /// probabilities 1, the result is the state itself. That is the default, because no values are published.
    ///
    /// # Errors
    /// As [`NeedVector::new`]; or a probability outside [0, 1]; or a different number of probabilities and
    /// needs.
    pub fn expected(state: &[f64], probabilities: &[f64]) -> Result<Self, NeedsError> {
        check_length("probabilities", state.len(), probabilities.len())?;
        check_probabilities(probabilities)?;
        Self::new(state.iter().zip(probabilities).map(|(n, p)| n * p).collect())
    }

    /// The values, one a need.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.0
    }
}

impl TryFrom<Vec<f64>> for NeedVector {
    type Error = NeedsError;

    fn try_from(values: Vec<f64>) -> Result<Self, NeedsError> {
        Self::new(values)
    }
}

impl NeedWeights {
    /// Takes the weights as they are; they need not add up to anything.
    ///
    /// # Errors
    /// No entry, an entry that is NaN, infinite or negative, or only zeros.
    pub fn new(weights: Vec<f64>) -> Result<Self, NeedsError> {
        check_entries("weights", &weights)?;
        if weights.iter().all(|w| *w == 0.0) {
            return Err(NeedsError::AllZero { what: "weights" });
        }
        Ok(Self(weights))
    }

    /// The weights, one a need.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.0
    }
}

impl NeedDistribution {
    /// The distribution of one robot: `d_k = n_k w_k / sum_k n_k w_k` (Eq. 8).
    ///
    /// # Errors
    /// Needs and weights of different lengths, or weighted needs that are all zero or too large to add up.
    pub fn of_agent(needs: &NeedVector, weights: &NeedWeights) -> Result<Self, NeedsError> {
        Self::of_group(std::slice::from_ref(needs), weights)
    }

    /// The distribution of a group: the members' weighted needs are summed first, then normalised,
    /// `D_k = sum_m n_mk w_k / sum_k sum_m n_mk w_k`. Of the readings of Eq. 9, only this one reproduces the
    /// distributions that the paper prints in its Example 2.
    ///
    /// # Errors
    /// An empty group; otherwise as [`NeedDistribution::of_agent`].
    pub fn of_group(members: &[NeedVector], weights: &NeedWeights) -> Result<Self, NeedsError> {
        let mut sums = vec![0.0; weights.0.len()];
        if members.is_empty() {
            return Err(NeedsError::Empty { what: "group" });
        }
        for member in members {
            check_length("needs", weights.0.len(), member.0.len())?;
            for ((sum, need), weight) in sums.iter_mut().zip(&member.0).zip(&weights.0) {
                *sum += need * weight;
            }
        }
        Self::normalise("weighted needs", &sums)
    }

    /// Takes shares that already add up to 1 (to within 1e-9).
    ///
    /// # Errors
    /// No entry, an entry that is NaN, infinite or negative, or another sum.
    pub fn from_shares(shares: Vec<f64>) -> Result<Self, NeedsError> {
        check_entries("distribution", &shares)?;
        let sum: f64 = shares.iter().sum();
        if (sum - 1.0).abs() > 1e-9 {
            return Err(NeedsError::NotNormalised { what: "distribution", found: sum });
        }
        Ok(Self(shares))
    }

    /// Divides each value by their sum. `what` names the values in errors.
    ///
    /// # Errors
    /// All values are 0, or their sum is too large.
    pub fn normalise(what: &'static str, values: &[f64]) -> Result<Self, NeedsError> {
        let mut shares = Vec::with_capacity(values.len());
        let sum = shares_into(values, &mut shares);
        if sum.is_normal() {
            Ok(Self(shares))
        } else if sum == 0.0 {
            Err(NeedsError::AllZero { what })
        } else {
            Err(NeedsError::Overflow { found: sum })
        }
    }

    /// The shares, one a need.
    #[must_use]
    pub fn shares(&self) -> &[f64] {
        &self.0
    }

    /// The same shares in ascending order: the literal reading of the last line of the paper's Algorithm 4.
    #[must_use]
    pub fn sorted(mut self) -> Self {
        self.0.sort_by(f64::total_cmp);
        self
    }
}

/// Writes the share of each value in their sum to `shares` (Eqs. 8 and 9) and returns the sum. No other
/// function turns sums of weighted needs into shares.
#[inline]
pub fn shares_into(values: &[f64], shares: &mut Vec<f64>) -> f64 {
    let sum: f64 = values.iter().sum();
    shares.clear();
    shares.extend(values.iter().map(|value| value / sum));
    sum
}

/// The share of each value in their sum.
#[must_use]
pub fn shares_of(values: &[f64]) -> Vec<f64> {
    let mut shares = Vec::with_capacity(values.len());
    shares_into(values, &mut shares);
    shares
}

/// Checks that there is at least one entry and that every entry is finite and >= 0.
pub(crate) fn check_entries(what: &'static str, values: &[f64]) -> Result<(), NeedsError> {
    if values.is_empty() {
        return Err(NeedsError::Empty { what });
    }
    match values.iter().position(|v| !v.is_finite() || *v < 0.0) {
        Some(index) => Err(NeedsError::OutOfRange { what, index, found: values[index] }),
        None => Ok(()),
    }
}

/// Checks that the lengths agree. `what` names the list in the error.
///
/// # Errors
/// They do not.
pub fn check_length(what: &'static str, expected: usize, found: usize) -> Result<(), NeedsError> {
    if expected == found { Ok(()) } else { Err(NeedsError::Length { what, expected, found }) }
}

/// Checks that every entry is in [0, 1].
pub(crate) fn check_probabilities(values: &[f64]) -> Result<(), NeedsError> {
    match values.iter().position(|p| !(0.0..=1.0).contains(p)) {
        Some(index) => {
            Err(NeedsError::OutOfRange { what: "probabilities (at most 1)", index, found: values[index] })
        }
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_needs_are_named_with_their_place() {
        let message = NeedVector::new(vec![1.0, f64::NAN]).unwrap_err().to_string();
        assert_eq!(message, "needs[1] must be a finite number >= 0, found NaN");
        assert_eq!(NeedVector::new(vec![]).unwrap_err(), NeedsError::Empty { what: "needs" });
        assert_eq!(NeedWeights::new(vec![0.0; 3]).unwrap_err(), NeedsError::AllZero { what: "weights" });
        for bad in [-1.0, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(matches!(NeedVector::new(vec![bad]), Err(NeedsError::OutOfRange { index: 0, .. })));
        }
    }

    #[test]
    fn needs_too_large_to_add_up_are_an_error_and_not_infinity() {
        let weights = NeedWeights::new(vec![1.0, 1.0]).unwrap();
        let needs = NeedVector::new(vec![1.7e308, 1.7e308]).unwrap();
        assert!(matches!(NeedDistribution::of_agent(&needs, &weights), Err(NeedsError::Overflow { .. })));
    }

    #[test]
    fn probabilities_weigh_the_state() {
        let needs = NeedVector::expected(&[10.0, 4.0], &[0.5, 1.0]).unwrap();
        assert_eq!(needs.values(), [5.0, 4.0]);
        assert!(NeedVector::expected(&[1.0], &[1.5]).is_err());
        assert!(NeedVector::expected(&[1.0], &[f64::NAN]).is_err());
    }
}
