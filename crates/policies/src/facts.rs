//! Facts of a question that several policies need.

use teaming::error::PolicyError;

/// The square of the distance between two places, in square metres.
pub(super) fn squared_distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
    dx * dx + dy * dy
}

/// The error of a policy to which the question does not tell what it needs.
pub(super) fn missing(policy: &str, what: &'static str, robot: Option<u32>) -> PolicyError {
    PolicyError::MissingFact { policy: policy.to_owned(), what, robot }
}
