//! How good single decisions were: what would have come of every other assignment, decision by decision,
//! and how far each policy stays behind the best.

mod analysis;
mod decision;
mod features;
mod log;
mod study;

pub use analysis::{Analysis, DecisionRow, Estimate, FeatureRow, PolicyRegret, analyse};
pub use decision::{Plan, PlayedDecision, Sample, play_decisions};
pub use log::{DecisionKey, OutcomeLog};
pub use study::{Choices, PlayedTrial, Study, StudyFolder};
