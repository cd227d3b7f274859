//! The built-in policies, one file each.

pub mod distance;
pub mod energy;
pub mod hp_distance;
pub mod random;
mod ranking;
pub mod rne;

use crate::error::PolicyError;

fn squared_distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
    dx * dx + dy * dy
}

fn missing(policy: &str, what: &'static str, robot: Option<u32>) -> PolicyError {
    PolicyError::MissingFact { policy: policy.to_owned(), what, robot }
}
