//! The summary of a trial: its status and the values of its metrics.

use serde::{Deserialize, Serialize};
use store::{Failure, refuse};
use usar_sim::fit::is_result;
use usar_sim::record::{Status, TrialRecord};

use crate::metric::Catalogue;
use crate::run::FaultKind;

/// The summary of a trial that ran to its end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Summary {
    /// Its status in one word.
    pub status: String,
    /// Values of all metrics, in the order of the experiment's catalogue.
    pub metrics: Vec<Option<f64>>,
    /// Hash of its last state.
    pub state_hash: String,
}

impl Summary {
    pub(super) fn of(record: &TrialRecord, metrics: &Catalogue) -> Self {
        let status = record.status.name().to_owned();
        Self { status, metrics: metrics.measure(record), state_hash: record.state_hash.clone() }
    }

    /// Checks that this can be the summary of a trial with these metrics.
    pub(super) fn check(&self, metrics: &Catalogue) -> Result<(), Failure> {
        let (count, found) = (metrics.len(), self.metrics.len());
        if count != found {
            refuse!("must have {count} metrics, found {found}");
        }
        if let Some(value) = self.metrics.iter().flatten().find(|value| !is_result(**value)) {
            refuse!("has the metric {value:e}, which no trial has");
        }
        let no_status = || Failure::input(format!("has no status {:?}", self.status));
        status_of(&self.status).map(drop).ok_or_else(no_status)
    }
}

/// The status with this name.
pub(super) fn status_of(name: &str) -> Option<&'static str> {
    let ended = [Status::Completed, Status::NobodyCanCarry, Status::Finished, Status::Stalled];
    let ended = ended.map(|status| status.name());
    let faults = FaultKind::ALL.map(FaultKind::name);
    ended.into_iter().chain(faults).find(|known| *known == name)
}
