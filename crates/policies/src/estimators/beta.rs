//! `Beta(forget, tolerance)`: the Beta reputation of a robot.
//!
//! `r <- forget r + o`, `s <- forget s + 1 - o`, trust `(r + 1) / (r + s + 2)`, over the outcomes `o` of the
//! base and of the mates alike (Josang, Ismail 2002, *The Beta Reputation System*). Earlier rounds are
//! forgotten once in each round with an outcome, so that the order within a round does not matter. A round
//! without one changes nothing.

use teaming::{Estimate, Estimator, EstimatorKind, PolicyError, Question};

use super::counts::Counts;
use super::last_said::{last_said, last_said_with};
use super::outcomes::{Outcome, Outcomes, TOLERANCE};

teaming::options! {
    /// Believes robots by their outcomes, whoever gave them; levels are those said last.
    #[derive(Copy)]
    pub struct Beta {
        /// Weight of what was known a round ago, above 0 and at most 1.
        pub forget: f64 = 0.9,
        /// How far from what was said a speed may be until it counts as false, as a share of top speed,
        /// above 0.
        pub tolerance: f64 = TOLERANCE,
    }
}

/// The registry's line.
#[must_use]
pub fn kind() -> EstimatorKind {
    EstimatorKind::with_options("Beta", "trust as a Beta reputation that forgets", Beta::checked)
        .from_sources(env!("SOURCES_ESTIMATOR_BETA"))
}

impl Beta {
    fn checked(self) -> Result<Self, &'static str> {
        let Self { forget, tolerance } = self;
        if !(forget > 0.0 && forget <= 1.0) {
            return Err("forget must be above 0 and at most 1");
        }
        let is_share = tolerance.is_finite() && tolerance > 0.0;
        if is_share { Ok(self) } else { Err("tolerance must be a number above 0") }
    }
}

impl Estimator for Beta {
    fn judges_trust_only(&self) -> bool {
        true
    }

    fn estimate(&self, question: &Question) -> Result<Vec<Estimate>, PolicyError> {
        let Some(evidence) = &question.evidence else { return last_said(question) };
        let outcomes = Outcomes::of(question, evidence, self.tolerance);
        let trust = |id: u32| reputation(outcomes.about(id), self.forget).mean();
        last_said_with(question, question.members.iter().map(|member| trust(member.id)))
    }
}

/// The counts of outcomes about one robot, in the order of their rounds.
fn reputation(outcomes: &[Outcome], forget: f64) -> Counts {
    let mut counts = Counts::default();
    for round in outcomes.chunk_by(|a, b| a.round == b.round) {
        counts.forget(forget);
        round.iter().for_each(|outcome| counts.add(outcome.outcome));
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(outcomes: &[f64], forget: f64) -> [f64; 4] {
        let outcome = |(round, outcome): (u32, &f64)| Outcome { of: 0, by: None, round, outcome: *outcome };
        let outcomes: Vec<Outcome> = (1..).zip(outcomes).map(outcome).collect();
        let counts = reputation(&outcomes, forget);
        [counts.good, counts.bad, counts.mean(), counts.sd()]
    }

    /// Reference: an independent implementation in Python. By the formula, 18 good outcomes have a mean of
    /// 19 / 20.
    #[test]
    fn reputations_are_as_computed_elsewhere() {
        let cases = [
            (of(&[1.0, 1.0, 0.0], 1.0), [2.0, 1.0, 0.6, 0.2]),
            (
                of(&[1.0, 1.0, 1.0, 0.0, 0.0], 0.9),
                [2.1951, 1.9, 0.524_207_970_336_827_9, 0.187_491_304_519_343_44],
            ),
            (of(&[0.7, 0.2, 0.95], 0.8), [1.558, 0.882, 0.576_126_126_126_126, 0.211_873_997_013_515_8]),
        ];
        for (found, expected) in cases {
            let is_near =
                found.iter().zip(expected).all(|(found, expected)| (found / expected - 1.0).abs() < 1e-9);
            assert!(is_near, "{found:?} {expected:?}");
        }
        assert!((of(&[1.0; 18], 1.0)[2] - 0.95).abs() < 1e-12);
    }
}
