//! Beliefs: what a group, or the team at home, holds true. A belief is a fold over the reports that were
//! heard. It has numbers, places and shapes of its own, so that it can be late, wrong, or about things that
//! do not exist.

mod fold;
mod known;
mod ledger;
mod news;
mod robot;
mod shared;
mod table;
#[cfg(test)]
mod tests;

pub use fold::Belief;
pub use known::{KnownDebris, KnownRescuee, KnownTask, KnownWreck, KnownZone};
pub use ledger::Ledger;
pub(crate) use news::{News, Seen};
pub use robot::KnownRobot;
pub use shared::{Beliefs, Holder};
pub use table::Table;
