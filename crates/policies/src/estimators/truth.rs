//! `Truth`: every level as it is. A control: what a perfect estimator would be worth.

use teaming::estimate::as_said;
use teaming::{Estimate, Estimator, EstimatorKind, PolicyError, Question};

/// Takes the true levels of the evidence, with the needs that follow from them; believes everybody. It is no
/// estimator that a team could have.
#[derive(Debug, Clone, Copy)]
pub struct Truth;

/// The registry's line.
#[must_use]
pub fn kind() -> EstimatorKind {
    EstimatorKind::plain("Truth", "control: every level as it is", Truth)
        .from_sources(env!("SOURCES_ESTIMATOR_TRUTH"))
}

impl Estimator for Truth {
    fn estimate(&self, question: &Question) -> Result<Vec<Estimate>, PolicyError> {
        let mut estimates = as_said(question)?;
        let Some(evidence) = &question.evidence else { return Ok(estimates) };
        for (estimate, member) in estimates.iter_mut().zip(&question.members) {
            if let Ok(place) = evidence.truth.binary_search_by_key(&member.id, |levels| levels.robot) {
                let levels = [evidence.truth[place].energy_level, evidence.truth[place].hp_level];
                *estimate = Estimate::of_levels(member, evidence, levels, [0.0; 2])?;
            }
        }
        Ok(estimates)
    }
}
