//! What groups believe of the world, and how they come to believe it.

mod knowledge;
mod sensing;

pub use knowledge::{Inflation, Knowledge};
pub(crate) use knowledge::{News, Seen};
pub use sensing::{SENSING_PERIOD_STEPS, look_around};
