//! The beliefs of groups about the world, and how sensing forms them.

mod knowledge;
mod sensing;

pub use knowledge::{Inflation, Knowledge};
pub(crate) use knowledge::{News, Seen};
pub use sensing::{SENSING_PERIOD_STEPS, look_around};
