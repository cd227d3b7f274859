//! Scores of estimates and of probabilities against what was true.
//!
//! Each is `None` where it is not defined, and never 0 in the place of that.

use std::cmp::Ordering;

use statrs::distribution::{Continuous, ContinuousCDF, Normal};

/// A probability that something is so, and whether it was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forecast {
    /// The probability, from 0 to 1.
    pub probability: f64,
    /// Whether it was so.
    pub was_so: bool,
}

/// Number of bins of [`calibration_error`].
const BINS: usize = 10;

/// Probabilities of 0 and 1 count as this far from it in [`log_score`]: a certain error costs 27.6, not
/// infinity.
const LEAST_PROBABILITY: f64 = 1e-12;

/// The continuous ranked probability score of a normal forecast (Gneiting and Raftery 2007, eq. 21), in the
/// unit of the value; the absolute error where `sd` is 0. Lower is better.
pub fn crps(mean: f64, sd: f64, value: f64) -> f64 {
    if sd <= 0.0 {
        return (value - mean).abs();
    }
    let (z, normal) = ((value - mean) / sd, Normal::standard());
    sd * (z * (2.0 * normal.cdf(z) - 1.0) + 2.0 * normal.pdf(z) - 1.0 / std::f64::consts::PI.sqrt())
}

/// Kendall's rank correlation with ties (tau-b, Kendall 1945), from -1 to 1; `None` if either side has one
/// value only.
pub fn tau_b(x: &[f64], y: &[f64]) -> Option<f64> {
    let sign = |a: f64, b: f64| match a.total_cmp(&b) {
        Ordering::Less => -1,
        Ordering::Equal => 0,
        Ordering::Greater => 1,
    };
    let (mut agree, mut of_x, mut of_y) = (0_i64, 0_i64, 0_i64);
    for i in 0..x.len().min(y.len()) {
        for j in 0..i {
            let [in_x, in_y] = [sign(x[i], x[j]), sign(y[i], y[j])];
            agree += in_x * in_y;
            of_x += in_x.abs();
            of_y += in_y.abs();
        }
    }
    let pairs = (of_x as f64 * of_y as f64).sqrt();
    (pairs > 0.0).then(|| agree as f64 / pairs)
}

/// The area under the receiver operating characteristic: how often a forecast of something that was so is
/// higher than one of something that was not, ties by half (Mann and Whitney). `None` if one kind is missing.
pub fn area_under_curve(forecasts: &[Forecast]) -> Option<f64> {
    let of = |was_so: bool| forecasts.iter().filter(move |it| it.was_so == was_so).map(|it| it.probability);
    let pairs = of(true).count() * of(false).count();
    let wins = of(true).flat_map(|so| {
        of(false).map(move |not| match so.total_cmp(&not) {
            Ordering::Less => 0.0,
            Ordering::Equal => 0.5,
            Ordering::Greater => 1.0,
        })
    });
    (pairs > 0).then(|| wins.sum::<f64>() / pairs as f64)
}

/// The mean squared error of probabilities (Brier 1950). Lower is better.
pub fn brier(forecasts: &[Forecast]) -> Option<f64> {
    mean(forecasts, |it| (it.probability - f64::from(it.was_so)).powi(2))
}

/// The mean logarithmic score (Good 1952), in nats. Lower is better.
pub fn log_score(forecasts: &[Forecast]) -> Option<f64> {
    mean(forecasts, |it| {
        let of_what_was = if it.was_so { it.probability } else { 1.0 - it.probability };
        -of_what_was.max(LEAST_PROBABILITY).ln()
    })
}

/// The expected calibration error in ten bins of equal width (Naeini et al. 2015): how far the mean
/// probability in a bin is from the share that was so. Lower is better.
pub fn calibration_error(forecasts: &[Forecast]) -> Option<f64> {
    let mut bins = [[0.0; 2]; BINS];
    for it in forecasts {
        let bin = ((it.probability * BINS as f64) as usize).min(BINS - 1);
        bins[bin][0] += it.probability;
        bins[bin][1] += f64::from(it.was_so);
    }
    let apart: f64 = bins.iter().map(|[said, was]| (said - was).abs()).sum();
    (!forecasts.is_empty()).then(|| apart / forecasts.len() as f64)
}

fn mean(forecasts: &[Forecast], score: impl Fn(&Forecast) -> f64) -> Option<f64> {
    let sum: f64 = forecasts.iter().map(score).sum();
    (!forecasts.is_empty()).then(|| sum / forecasts.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is(found: Option<f64>, expected: f64) {
        let found = found.unwrap();
        assert!((found - expected).abs() <= 1e-9 * expected.abs(), "{found} {expected}");
    }

    /// The first is of Alpha Testbed (Jelenc et al. 2013), computed independently like the others.
    #[test]
    fn rank_correlations_are_as_computed_elsewhere() {
        let x = [-1.0, 1.0, 1.0, 0.0, 1.0, 0.0, -1.0, 1.0, 0.0, 1.0];
        let y = [-1.0, 1.0, 0.0, -1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0];
        is(tau_b(&x, &y), 0.730_250_730_251_095_3);
        assert_eq!(tau_b(&[1.0, 1.0, 1.0], &[1.0, 2.0, 3.0]), None);
        is(tau_b(&[1.0, 2.0, 3.0], &[3.0, 2.0, 1.0]), -1.0);
    }

    #[test]
    fn scores_of_probabilities_are_as_computed_elsewhere() {
        let all = [0.9, 0.8, 0.3, 0.1, 0.6].map(|probability| Forecast { probability, was_so: false });
        let mut all = all;
        all[..2].iter_mut().for_each(|it| it.was_so = true);
        is(brier(&all), 0.102);
        is(log_score(&all), 0.341_366_051_688_55);
        is(area_under_curve(&all), 1.0);
        is(calibration_error(&all), 0.26);
        assert_eq!(area_under_curve(&all[..2]), None);
        assert_eq!([brier(&[]), log_score(&[]), calibration_error(&[])], [None; 3]);
        let certain = [Forecast { probability: 0.0, was_so: true }];
        assert!(log_score(&certain).unwrap().is_finite());
        let ties = [true, false].map(|was_so| Forecast { probability: 0.5, was_so });
        is(area_under_curve(&ties), 0.5);
    }

    #[test]
    fn the_ranked_probability_score_is_as_computed_elsewhere() {
        is(Some(crps(60.0, 5.0, 66.0)), 3.740_076_589_432_848_5);
        is(Some(crps(60.0, 0.0, 66.0)), 6.0);
    }
}
