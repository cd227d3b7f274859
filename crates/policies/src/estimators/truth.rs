//! `Truth`: every level as it is. A control: what a perfect estimator would be worth.

use teaming::estimate::as_said;
use teaming::{Estimate, Estimator, EstimatorKind, PolicyError, Question, Truth as Told};

/// Takes the levels as they really are, with the needs that follow from them; believes everybody. It is no
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
        if question.evidence.is_none() { as_said(question) } else { Err(PolicyError::NoTruth) }
    }

    fn needs_truth(&self) -> bool {
        true
    }

    fn estimate_with(&self, question: &Question, truth: Told<'_>) -> Result<Vec<Estimate>, PolicyError> {
        let mut estimates = as_said(question)?;
        let Some(evidence) = &question.evidence else { return Ok(estimates) };
        for (estimate, member) in estimates.iter_mut().zip(&question.members) {
            let levels = truth.of(member.id).and_then(|is| is.levels.iter().copied().collect());
            if let Some(levels) = levels {
                let sd = std::mem::take(&mut estimate.sd);
                *estimate = Estimate::of_levels(member, evidence, levels, sd)?;
            }
        }
        Ok(estimates)
    }
}
