//! The built-in policies, one file each.

pub mod distance;
pub mod energy;
mod facts;
pub mod hp_distance;
pub mod random;
mod ranking;
pub mod rne;
