//! The medium: which of the reports that were sent are heard, and when.

use crate::model::Model;
use crate::report::Report;

/// Moves the reports that are heard in this step from `sent` to `heard`, by the medium of the trial. This is
/// the one place that chooses a medium.
pub(crate) fn carry(_model: &Model, step: u64, sent: &mut Vec<Report>, heard: &mut Vec<Report>) {
    Perfect.carry(step, sent, heard);
}

/// Carries reports from senders to beliefs.
pub trait Medium {
    /// Moves the reports that are heard in this step from `sent` to `heard`, in the order in which they are
    /// heard. Reports that stay in `sent` are under way.
    fn carry(&self, step: u64, sent: &mut Vec<Report>, heard: &mut Vec<Report>);
}

/// A medium that delivers every report at once and unchanged.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Perfect;

impl Medium for Perfect {
    fn carry(&self, _step: u64, sent: &mut Vec<Report>, heard: &mut Vec<Report>) {
        heard.append(sent);
    }
}
