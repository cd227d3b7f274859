//! A cautious interval of a mean, for verdicts that must seldom be wrong.
//!
//! At high confidence, the t interval and the bootstrap interval of few skewed differences are too narrow:
//! the tail that decides was not seen yet. This interval is the wider of the two. Its t interval is widened
//! for skewness, to first order in 1 / sqrt(n) (Johnson 1978, "Modified t tests and confidence intervals for
//! asymmetrical populations", JASA 73). The skewness is taken three standard errors beyond the sample's.
//! `xtask coverage` measures how often verdicts from it are wrong.

use std::collections::HashMap;

use statrs::distribution::{ContinuousCDF, StudentsT};

use super::Moments;

/// Fewest differences other than the commonest one.
const LEAST_OTHERS: f64 = 8.0;

/// [`LEAST_OTHERS`] suffice down to this error of an interval. Below it, the number grows with the inverse
/// square root of the error.
const ERROR_OF_LEAST: f64 = 1.0 / 400.0;

/// Standard errors by which the true skewness may exceed the sample's.
const SKEWNESS_ERRORS: f64 = 3.0;

/// How many values must differ from the commonest one for an interval at this confidence.
pub fn least_others(confidence: f64) -> usize {
    let error = 1.0 - confidence;
    (LEAST_OTHERS * (ERROR_OF_LEAST / error).sqrt().max(1.0)).round() as usize
}

/// How many of the values differ from the commonest one.
pub fn others(values: &[f64]) -> usize {
    let mut counts: HashMap<u64, usize> = HashMap::new();
    // Adding 0 makes a 0 of -0.
    values.iter().for_each(|value| *counts.entry((value + 0.0).to_bits()).or_default() += 1);
    values.len() - counts.into_values().max().unwrap_or(0)
}

/// The interval of the mean at this confidence, around the bootstrap interval. `None` if too few values
/// differ from the commonest one.
pub fn around(
    values: &[f64],
    confidence: f64,
    bootstrap: impl FnOnce() -> Option<[f64; 2]>,
) -> Option<[f64; 2]> {
    if others(values) < least_others(confidence) {
        return None;
    }
    let [low, high] = bootstrap()?;
    let [t_low, t_high] = t_interval(values, confidence)?;
    Some([low.min(t_low), high.max(t_high)])
}

/// The t interval, each end widened for the skewness that may be there.
fn t_interval(values: &[f64], confidence: f64) -> Option<[f64; 2]> {
    let count = values.len() as f64;
    let Moments { mean: Some(mean), sd: Some(sd), .. } = Moments::of(values) else { return None };
    let power = |exponent: i32| values.iter().map(|value| (value - mean).powi(exponent)).sum::<f64>() / count;
    let skewness = power(3) / power(2).powf(1.5);
    let error = SKEWNESS_ERRORS * (6.0 / count).sqrt();
    let t = StudentsT::new(0.0, 1.0, count - 1.0).ok()?.inverse_cdf(f64::midpoint(1.0, confidence));
    let half = |skewness: f64| {
        let widened = t + skewness.max(0.0) * (2.0 * t * t + 1.0) / (6.0 * count.sqrt());
        widened * sd / count.sqrt()
    };
    Some([mean - half(error - skewness), mean + half(error + skewness)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bootstrap;
    use crate::paired::t_half_width_at;

    /// Twenty quantiles of the exponential distribution: its long tail lies beyond the largest of them.
    #[test]
    fn the_interval_holds_both_others_and_reaches_further_into_the_longer_tail() {
        let values: Vec<f64> = (0..20).map(|i| -(1.0 - (f64::from(i) + 0.5) / 20.0).ln()).collect();
        let (mean, confidence) = (Moments::of(&values).mean.unwrap(), 0.9995);
        let half = t_half_width_at(&values, confidence).unwrap();
        let [low, high] = bootstrap::interval(&values, confidence).unwrap();
        let [least, most] = around(&values, confidence, || Some([low, high])).unwrap();
        assert!(least <= low.min(mean - half), "{least}");
        assert!(most - mean > 1.5 * (high.max(mean + half) - mean), "{most}, {high}, {half}");
    }

    #[test]
    fn values_other_than_the_commonest_are_counted() {
        assert_eq!(others(&[]), 0);
        assert_eq!(others(&[0.0, -0.0, 1.0, 2.0]), 2);
        assert_eq!([0.95, 0.9975, 0.9996].map(least_others), [8, 8, 20]);
    }
}
