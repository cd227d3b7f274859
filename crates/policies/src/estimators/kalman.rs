//! `Kalman(q, r, gate, restart)`: a Kalman filter with a gate for each level of each robot.
//!
//! A level is expected to fall by what the robot's fit group-mates said that they spent: `x- = x - used`,
//! `P- = P + q`; where no mate can tell, `x- = x`, `P- = P + 400`; after a rest `x- = 100`, `P- = q`; at
//! first `x-` and `P-` are what the base expects. With `S = P- + r`, a report `z` fails if `(z - x-)^2 / S >
//! gate`, and changes nothing then; else `K = P- / S`, `x = x- + K (z - x-)`, `P = (1 - K) P-`. The
//! `restart`-th report in a row that fails begins the level anew: `x = z`, `P = r`, as a track is begun by
//! its first measurement; it counts as failed. So a robot that lost much at once, by something that its
//! mates did not meet, is believed again; so is a liar that goes on, at a lower trust. Trust is the mean of
//! a Beta distribution of passes and failures of all levels: `(passes + 1) / (passes + failures + 2)`. The
//! gate of 6.6349 is the 99 % point of a chi-square distribution with one degree of freedom (Bar-Shalom, Li,
//! Kirubarajan 2001, *Estimation with Applications to Tracking and Navigation*, 5.4).

use teaming::estimate::as_said;
use teaming::{Estimate, Estimator, EstimatorKind, PolicyError, Question};

use super::filter::{Rules, estimate, follow};
use super::rounds::rounds;

teaming::options! {
    /// Filters the levels of each robot; believes those whose reports pass.
    #[derive(Copy)]
    pub struct Kalman {
        /// Variance by which a level becomes less sure in each round, in square percent points.
        pub q: f64 = 4.0,
        /// Variance of a report, in square percent points.
        pub r: f64 = 25.0,
        /// Greatest squared error of a report in terms of its variance; a report beyond it fails.
        pub gate: f64 = 6.6349,
        /// Reports in a row that fail until a level begins anew; 0 if it never does.
        pub restart: u32 = 2,
    }
}

/// The registry's line.
#[must_use]
pub fn kind() -> EstimatorKind {
    EstimatorKind::with_options("Kalman", "levels filtered by what group-mates spent", Kalman::checked)
        .from_sources(env!("SOURCES_ESTIMATOR_KALMAN"))
}

impl Kalman {
    fn checked(self) -> Result<Self, String> {
        let Self { q, r, gate, .. } = self;
        match [("q", q), ("r", r), ("gate", gate)].into_iter().find(|(_, v)| !(v.is_finite() && *v > 0.0)) {
            Some((name, _)) => Err(format!("{name} must be a number above 0")),
            None => Ok(self),
        }
    }
}

impl Estimator for Kalman {
    fn estimate(&self, question: &Question) -> Result<Vec<Estimate>, PolicyError> {
        let Some(evidence) = &question.evidence else { return as_said(question) };
        let Self { q, r, gate, restart } = *self;
        let rules = Rules { q, r, gate, restart };
        let of = |(member, seen): (_, Vec<_>)| {
            let (guesses, passes) = follow(question, &seen, &rules, true);
            Ok(Estimate { trust: passes.mean(), ..estimate(member, evidence, &guesses)? })
        };
        question.members.iter().zip(rounds(question, evidence)).map(of).collect()
    }
}
