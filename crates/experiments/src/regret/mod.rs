//! Regret: how good single decisions were. For each decision, the outcomes of every other assignment, and
//! the distance of each policy's choice to the best one.

mod analysis;
mod decision;
mod features;
mod log;
mod study;

pub use analysis::{Analysis, Criteria, DecisionRow, Estimate, FeatureRow, PolicyRegret, analyse};
pub use decision::{Plan, PlayedDecision, Sample, play_decisions};
pub use log::{DecisionKey, OutcomeLog};
pub use study::{Choices, PlayedTrial, SUMMARY, Study, StudyFolder, TABLE};
