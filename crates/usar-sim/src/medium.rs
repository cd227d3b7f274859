//! The medium: which of the reports that were sent are heard, and when.

use crate::report::Report;

/// Carries reports from senders to beliefs.
pub trait Medium {
    /// Moves the reports that are heard in this step from `sent` to `heard`, in the order in which they are
    /// heard. Reports that stay in `sent` are under way.
    fn carry(&self, step: u64, sent: &mut Vec<Report>, heard: &mut Vec<Report>);
}

/// A medium that delivers every report at once and unchanged.
#[derive(Debug, Clone, Copy, Default)]
pub struct Perfect;

impl Medium for Perfect {
    fn carry(&self, _step: u64, sent: &mut Vec<Report>, heard: &mut Vec<Report>) {
        heard.append(sent);
    }
}
