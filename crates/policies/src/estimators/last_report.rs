//! `LastReport`: everybody is as they said last. It is what a policy without an estimator goes by.

use teaming::{Estimate, Estimator, EstimatorKind, PolicyError, Question};

use super::last_said::last_said;

/// Takes the members as the question has them, needs that were said by themselves included, and the
/// deviations of their gauges as sure as they say; believes everybody.
#[derive(Debug, Clone, Copy)]
pub struct LastReport;

/// The registry's line.
#[must_use]
pub fn kind() -> EstimatorKind {
    EstimatorKind::plain("LastReport", "everybody is as they said last", LastReport)
        .from_sources(env!("SOURCES_ESTIMATOR_LAST_REPORT"))
}

impl Estimator for LastReport {
    fn estimate(&self, question: &Question) -> Result<Vec<Estimate>, PolicyError> {
        last_said(question)
    }
}
