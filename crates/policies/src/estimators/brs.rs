//! `Brs(q)`: a Beta reputation from which unfair raters are filtered.
//!
//! `R` is the mean of `Beta(1 + r, 1 + s)` over the base's own outcomes and those of the raters that are
//! kept. A rater is dropped if `R` lies outside the `q` and `1 - q` quantiles of its own Beta distribution;
//! all that miss are dropped at once, and again, until none does (Whitby, Josang, Indulska 2004, *Filtering
//! Out Unfair Ratings in Bayesian Reputation Systems*). `R` lies below the `q` quantile where the
//! distribution is less likely than `q` to be below `R`, so that no quantile is computed.

use teaming::{Estimate, Estimator, EstimatorKind, PolicyError, Question};

use super::counts::Counts;
use super::incomplete_beta::below;
use super::last_said::{last_said, last_said_with};
use super::outcomes::{Outcomes, TOLERANCE, by_rater};

teaming::options! {
    /// Believes robots by the outcomes of the base and of the fair raters; levels are those said last.
    #[derive(Copy)]
    pub struct Brs {
        /// How unlikely a rater must be to be dropped: a probability above 0 and below 0.5.
        pub q: f64 = 0.01,
    }
}

/// The registry's line.
#[must_use]
pub fn kind() -> EstimatorKind {
    EstimatorKind::with_options("Brs", "trust as a Beta reputation without unfair raters", Brs::checked)
        .from_sources(env!("SOURCES_ESTIMATOR_BRS"))
}

impl Brs {
    fn checked(self) -> Result<Self, &'static str> {
        let is_tail = self.q > 0.0 && self.q < 0.5;
        if is_tail { Ok(self) } else { Err("q must be above 0 and below 0.5") }
    }
}

impl Estimator for Brs {
    fn judges_trust_only(&self) -> bool {
        true
    }

    fn estimate(&self, question: &Question) -> Result<Vec<Estimate>, PolicyError> {
        let Some(evidence) = &question.evidence else { return last_said(question) };
        let outcomes = Outcomes::of(question, evidence, TOLERANCE);
        let trust = |id: u32| {
            let (own, mut raters) = by_rater(outcomes.about(id));
            reputation(own, &mut raters, self.q)
        };
        last_said_with(question, question.members.iter().map(|member| trust(member.id)))
    }
}

/// The reputation by the base's own counts and by those of raters; leaves the raters that are kept.
fn reputation(own: Counts, raters: &mut Vec<(u32, Counts)>, q: f64) -> f64 {
    loop {
        let mut all = own;
        raters.iter().for_each(|(_, counts)| all.join(*counts));
        let mean = all.mean();
        let before = raters.len();
        raters.retain(|(_, counts)| {
            let below = below(mean, counts.beta());
            q <= below && below <= 1.0 - q
        });
        if raters.len() == before {
            return mean;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reference: an independent implementation in Python of the cases of Alpha Testbed.
    #[test]
    fn reputations_are_as_published() {
        let counts = |good: f64, bad: f64| Counts { good, bad };
        let found = |own: Counts, goods: [f64; 8]| {
            let mut raters: Vec<(u32, Counts)> =
                (1..).zip(goods).map(|(id, good)| (id, counts(good, 10.0 - good))).collect();
            let mean = reputation(own, &mut raters, 0.01);
            (mean, raters.iter().map(|(id, _)| *id).collect::<Vec<_>>())
        };
        let (mean, kept) = found(counts(10.0, 0.0), [10.0, 10.0, 10.0, 10.0, 10.0, 0.0, 0.0, 10.0]);
        assert!((mean / 0.986_111_111_111_111_2 - 1.0).abs() < 1e-9);
        assert_eq!(kept, [1, 2, 3, 4, 5, 8]);
        let (mean, kept) = found(counts(0.0, 0.0), [6.0, 5.0, 7.0, 4.0, 6.0, 3.0, 0.0, 10.0]);
        assert!((mean / 0.516_129_032_258_064_5 - 1.0).abs() < 1e-9);
        assert_eq!(kept, [1, 2, 3, 4, 5, 6]);
    }
}
