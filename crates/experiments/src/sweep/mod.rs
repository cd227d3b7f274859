//! Storage of a sweep's results: its folder, its journal, and the tables made from it.

pub mod audit;
mod closing;
mod dictionary;
pub mod disk;
pub mod folder;
pub mod host;
mod journal;
mod line;
pub mod links;
mod measured;
pub mod merge;
mod missing;
pub mod names;
pub mod owned;
mod rows;
pub mod shards;
mod store;
mod summary;
mod tables;
mod tidy;

pub use self::tables::{Described, described};
pub use crate::experiment::Place;
pub use dictionary::columns_page;
pub use missing::{missing, run_trials};
pub use rows::trial_columns;
pub use tidy::{tidy_columns, tidy_rows};
