//! Paired comparisons with honest statistics, as functions of slices of numbers: no files, no threads, no
//! clock. The command and the page in a browser both call them, and therefore say the same.

pub mod bootstrap;
pub mod breakdown;
pub mod cautious;
pub mod comparison;
mod correlation;
pub mod paired;
pub mod scores;
pub mod sensitivity;
pub mod share;
pub mod stopping;
#[cfg(test)]
#[expect(clippy::float_cmp, reason = "ranks, counts and medians of them are exact")]
mod tests;
pub mod wilcoxon;

pub use correlation::rank_correlation;
use statrs::statistics::Statistics;

/// Mean and sample standard deviation of the trials in which a quantity is defined.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    /// Number of trials in which it is defined.
    pub count: usize,
    /// Mean; `None` without any trial.
    pub mean: Option<f64>,
    /// Sample standard deviation (divisor n - 1); `None` with fewer than two trials.
    pub sd: Option<f64>,
}

impl Moments {
    /// The moments of these values.
    pub fn of(values: &[f64]) -> Self {
        Self {
            count: values.len(),
            mean: (!values.is_empty()).then(|| values.mean()),
            sd: (values.len() > 1).then(|| values.std_dev()),
        }
    }
}

/// The programs in the README compile and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod moments {
    use super::*;

    #[test]
    fn the_standard_deviation_is_the_samples() {
        // numpy.std([2, 4, 4, 4, 5, 5, 7, 9], ddof=1)
        let moments = Moments::of(&[2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]);
        assert!((moments.mean.unwrap() - 5.0).abs() < 1e-12);
        assert!((moments.sd.unwrap() - 2.138_089_935_299_395).abs() < 1e-12);
    }

    #[test]
    fn what_is_not_defined_is_nothing_and_not_nan() {
        assert_eq!(Moments::of(&[]), Moments { count: 0, mean: None, sd: None });
        assert_eq!(Moments::of(&[3.0]), Moments { count: 1, mean: Some(3.0), sd: None });
    }
}
