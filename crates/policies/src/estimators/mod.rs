//! The estimators of the house, one file each: what is true of each robot, how sure that is, and whom to
//! believe.
//!
//! Estimators of levels believe everybody; estimators of trust take levels as they were said last.
//! [`both`] joins one of each.

pub mod beta;
pub mod both;
pub mod brs;
mod counts;
pub mod cusum;
pub mod dead_reckoning;
pub mod eigen_trust;
mod filter;
pub mod hmm;
mod incomplete_beta;
pub mod kalman;
pub mod last_report;
mod last_said;
mod medians;
mod outcomes;
pub mod rne;
mod rounds;
pub mod smooth;
mod speeds;
pub mod travos;
pub mod truth;
pub mod wmsr;

use teaming::EstimatorKind;

/// All of them, the controls first.
pub(super) fn kinds() -> [EstimatorKind; 14] {
    [
        truth::kind(),
        dead_reckoning::kind(),
        last_report::kind(),
        smooth::kind(),
        kalman::kind(),
        beta::kind(),
        brs::kind(),
        travos::kind(),
        eigen_trust::kind(),
        hmm::kind(),
        cusum::kind(),
        rne::kind(),
        wmsr::kind(),
        both::kind(),
    ]
}
