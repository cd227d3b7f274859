//! How well the records fix each fitted value, and which values trade off against one another.
//!
//! Near the best candidate each residual is linear in the parameters, with slopes J from a regression on
//! the evaluated candidates. Residuals count standard errors, so the covariance of the fitted values is the
//! inverse of J'J (Gauss and Newton's approximation; Seber and Wild 1989, section 2.1).

use nalgebra::DMatrix;
use serde::Serialize;

use super::least_squares::LeastSquares;
use super::{Calibration, Evaluation};

/// Candidates count by their distance from the best one: at twice this share of a range, by 1/e.
const REACH: f64 = 0.06;

/// A flat prior over each range, as a standard deviation in shares of it: without it, what no candidate can
/// tell would have no standard error.
const PRIOR_SD: f64 = 0.289;

/// A fitted value, and how well it is known.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Identified {
    /// The parameter.
    pub parameter: String,
    /// Its fitted value.
    pub value: f64,
    /// Its standard error, as a share of its range; 0.289 where the records say nothing.
    pub standard_error: f64,
    /// The parameter with which it trades off the most.
    pub trades_off_with: String,
    /// Correlation of the two values: -1 or 1 where only a combination of them is known.
    pub correlation: f64,
}

impl Calibration {
    /// How well each value of the best of these evaluations is known; empty without any.
    pub fn identified(&self, evaluations: &[Evaluation]) -> Vec<Identified> {
        let runs = || evaluations.iter().filter(|evaluation| evaluation.failure.is_none());
        let Some(best) = runs().min_by(|a, b| a.misfit.total_cmp(&b.misfit)) else { return Vec::new() };
        let place = |one: &Evaluation| -> Vec<f64> {
            self.free.iter().zip(&one.values).map(|(free, value)| free.place_of(*value)).collect()
        };
        let mut known = LeastSquares::new(place(best), REACH);
        runs().for_each(|one| known.tell(&place(one), self.residuals(one)));
        let Some(covariance) = known.slopes().and_then(|slopes| covariance(&slopes)) else {
            return Vec::new();
        };
        let sd = |axis: usize| covariance[(axis, axis)].sqrt();
        let one = |axis: usize| {
            let correlation = |other: usize| covariance[(axis, other)] / (sd(axis) * sd(other));
            let others = (0..self.free.len()).filter(|other| *other != axis);
            let partner = others.max_by(|a, b| correlation(*a).abs().total_cmp(&correlation(*b).abs()));
            Identified {
                parameter: self.free[axis].name.clone(),
                value: best.values[axis],
                standard_error: sd(axis),
                trades_off_with: partner.map_or(String::new(), |other| self.free[other].name.clone()),
                correlation: partner.map_or(0.0, correlation),
            }
        };
        (0..self.free.len()).map(one).collect()
    }
}

/// The covariance of values whose residuals have these slopes, a row for each value.
fn covariance(slopes: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let prior = DMatrix::identity(slopes.nrows(), slopes.nrows()) / (PRIOR_SD * PRIOR_SD);
    Some((slopes * slopes.transpose() + prior).cholesky()?.inverse())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_two_values_that_act_together_only_their_sum_is_known() {
        // Two residuals of three values: the first knows the sum of the first two, the second knows the
        // third.
        let slopes = DMatrix::from_row_slice(3, 2, &[50.0, 0.0, 50.0, 0.0, 0.0, 50.0]);
        let found = covariance(&slopes).unwrap();
        let sd = |axis: usize| found[(axis, axis)].sqrt();
        assert!((found[(0, 1)] / (sd(0) * sd(1)) + 1.0).abs() < 0.01, "{found}");
        assert!(sd(0) > 0.2 && (sd(2) - 0.02).abs() < 0.001, "{found}");
        let nothing = covariance(&DMatrix::zeros(1, 1)).unwrap();
        assert!((nothing[(0, 0)].sqrt() - PRIOR_SD).abs() < 1e-12);
    }
}
