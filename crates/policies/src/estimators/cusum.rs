//! `Cusum(k, h)`: shortfalls of speed are summed up until they are too many.
//!
//! `S <- max(0, S + (1 - x) / 0.15 - k)` with `x` the speed that was seen in terms of the speed that was
//! said; trust `1 - min(1, S / h)` (Page 1954, *Continuous Inspection Schemes*). One `x` a round: the median
//! of the mates' ratings. A round without any changes nothing.

use teaming::{Estimate, Estimator, EstimatorKind, PolicyError, Question};

use super::last_said::{last_said, last_said_with};
use super::speeds::ratios;

/// Standard deviation of the speed seen in terms of the speed said, of a robot that says what is true.
const SD: f64 = 0.15;

teaming::options! {
    /// Believes robots that are not slower than they say for long; levels are those said last.
    #[derive(Copy)]
    pub struct Cusum {
        /// Shortfall of a round that is let pass, in standard deviations, from 0.
        pub k: f64 = 0.5,
        /// Sum of shortfalls at which nothing is believed, in standard deviations, above 0.
        pub h: f64 = 4.0,
    }
}

/// The registry's line.
#[must_use]
pub fn kind() -> EstimatorKind {
    EstimatorKind::with_options("Cusum", "trust by the sum of shortfalls of speed", Cusum::checked)
        .from_sources(env!("SOURCES_ESTIMATOR_CUSUM"))
}

impl Cusum {
    fn checked(self) -> Result<Self, &'static str> {
        let Self { k, h } = self;
        if !(k.is_finite() && k >= 0.0) {
            return Err("k must be a number from 0");
        }
        if h.is_finite() && h > 0.0 { Ok(self) } else { Err("h must be a number above 0") }
    }
}

impl Estimator for Cusum {
    fn judges_trust_only(&self) -> bool {
        true
    }

    fn estimate(&self, question: &Question) -> Result<Vec<Estimate>, PolicyError> {
        let Some(evidence) = &question.evidence else { return last_said(question) };
        let Self { k, h } = *self;
        let trust = |ratios: Vec<f64>| 1.0 - (sum(&ratios, k) / h).min(1.0);
        last_said_with(question, ratios(question, evidence).into_iter().map(trust))
    }
}

/// The sum of shortfalls after these rounds.
fn sum(ratios: &[f64], k: f64) -> f64 {
    ratios.iter().fold(0.0, |s, x| f64::max(0.0, s + (1.0 - x) / SD - k))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reference: an independent implementation in Python.
    #[test]
    fn sums_are_as_computed_elsewhere() {
        let ratios = [1.0, 0.8, 0.7, 0.75, 0.6];
        let expected = [0.0, 0.833_333_333_333_333, 2.333_333_333_333_333_5, 3.5, 5.666_666_666_666_667];
        for (count, expected) in (1..).zip(expected) {
            let found = sum(&ratios[..count], 0.5);
            assert!((found - expected).abs() <= 1e-9 * expected, "{found} {expected}");
        }
        let alarm = (1..=5).find(|count| sum(&ratios[..*count], 0.5) > 4.0);
        assert_eq!(alarm, Some(5));
    }
}
