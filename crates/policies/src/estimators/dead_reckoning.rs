//! `DeadReckoning`: no robot is asked. A control: what reports are worth.
//!
//! [`Kalman`](super::kalman) that takes no level from a robot's own reports: a level begins as the base
//! expects and falls by what the fit group-mates said that they spent; a rest fills it. A robot without a
//! group counts as rested if it last said that a level was below its threshold. The variance grows by 4
//! square percent points a round.

use teaming::estimate::as_said;
use teaming::{Estimate, Estimator, EstimatorKind, PolicyError, Question};

use super::filter::{Rules, estimate, follow};
use super::rounds::rounds;

/// The rules of `Kalman` by default.
const RULES: Rules = Rules { q: 4.0, r: 25.0, gate: 6.6349, restart: 0 };

/// Expects the levels of each robot and hears no report of it; believes everybody.
#[derive(Debug, Clone, Copy)]
pub struct DeadReckoning;

/// The registry's line.
#[must_use]
pub fn kind() -> EstimatorKind {
    let about = "control: levels as expected by what group-mates spent, without a robot's own reports";
    EstimatorKind::plain("DeadReckoning", about, DeadReckoning)
        .from_sources(env!("SOURCES_ESTIMATOR_DEAD_RECKONING"))
}

impl Estimator for DeadReckoning {
    fn estimate(&self, question: &Question) -> Result<Vec<Estimate>, PolicyError> {
        let Some(evidence) = &question.evidence else { return as_said(question) };
        let of = |(member, seen): (_, Vec<_>)| {
            estimate(member, evidence, &follow(question, &seen, &RULES, false).0)
        };
        question.members.iter().zip(rounds(question, evidence)).map(of).collect()
    }
}
