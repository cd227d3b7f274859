//! `Smooth(alpha)`: the reports of a robot, smoothed exponentially.
//!
//! `x <- alpha r + (1 - alpha) x`, from the first report on, with one report `r` a round (Brown 1959,
//! *Statistical Forecasting for Inventory Control*). The variance of independent reports goes along: `v <-
//! alpha^2 v_r + (1 - alpha)^2 v`.

use teaming::estimate::as_said;
use teaming::{Estimate, Estimator, EstimatorKind, PolicyError, Question};

use super::rounds::{Seen, rounds};

teaming::options! {
    /// Smooths the levels that each robot said; believes everybody. A robot that was never heard stays as the
    /// question has it. A smoothed level lags behind one that falls.
    #[derive(Copy)]
    pub struct Smooth {
        /// Weight of the last report, above 0 and at most 1.
        pub alpha: f64 = 0.4,
    }
}

/// The registry's line.
#[must_use]
pub fn kind() -> EstimatorKind {
    EstimatorKind::with_options("Smooth", "reports of levels, smoothed exponentially", Smooth::checked)
        .from_sources(env!("SOURCES_ESTIMATOR_SMOOTH"))
}

impl Smooth {
    fn checked(self) -> Result<Self, &'static str> {
        let is_weight = self.alpha > 0.0 && self.alpha <= 1.0;
        if is_weight { Ok(self) } else { Err("alpha must be above 0 and at most 1") }
    }
}

impl Estimator for Smooth {
    fn estimate(&self, question: &Question) -> Result<Vec<Estimate>, PolicyError> {
        let mut estimates = as_said(question)?;
        let Some(evidence) = &question.evidence else { return Ok(estimates) };
        let all = estimates.iter_mut().zip(&question.members).zip(rounds(question, evidence));
        for ((estimate, member), seen) in all {
            if let Some([levels, sd]) = smoothed(&seen, self.alpha) {
                *estimate = Estimate::of_levels(member, evidence, levels, sd)?;
            }
        }
        Ok(estimates)
    }
}

/// The levels and their standard deviations, once a report was heard.
fn smoothed(seen: &[Seen<'_>], alpha: f64) -> Option<[Vec<f64>; 2]> {
    let mut said = seen.iter().filter_map(|seen| seen.said);
    let first = said.next()?;
    let [mut levels, mut sds] = [first.levels, first.sd].map(<[f64]>::to_vec);
    for said in said {
        for (level, said) in levels.iter_mut().zip(said.levels) {
            *level = alpha * said + (1.0 - alpha) * *level;
        }
        for (sd, said) in sds.iter_mut().zip(said.sd) {
            let [new, old] = [alpha * said, (1.0 - alpha) * *sd];
            *sd = (new * new + old * old).sqrt();
        }
    }
    Some([levels, sds])
}

#[cfg(test)]
mod tests {
    use super::super::rounds::Said;
    use super::*;

    /// The level and its standard deviation.
    fn of(reports: &[f64], alpha: f64) -> [f64; 2] {
        let said = |level| Some(Said { levels: std::slice::from_ref(level), sd: &[2.0] });
        let seen: Vec<Seen<'_>> =
            reports.iter().map(|level| Seen { said: said(level), ..Seen::default() }).collect();
        smoothed(&seen, alpha).unwrap().map(|values| values[0])
    }

    /// Reference: an independent implementation in Python.
    #[test]
    fn reports_are_smoothed_as_computed_elsewhere() {
        assert!((of(&[80.0, 70.0, 75.0, 40.0], 0.4)[0] / 61.359_999_999_999_99 - 1.0).abs() < 1e-9);
        assert!((of(&[80.0, 70.0], 1.0)[0] - 70.0).abs() < 1e-12);
        // 0.4^2 4 + 0.6^2 4 = 2.08
        assert!((of(&[80.0, 70.0], 0.4)[1] - 2.08_f64.sqrt()).abs() < 1e-12);
    }
}
