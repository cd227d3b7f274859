//! Where the results of a sweep are kept: its folder, its journal, and the tables made of it.

pub mod audit;
mod dictionary;
pub mod disk;
pub mod folder;
mod journal;
pub mod links;
mod missing;
pub mod ours;
mod parquet;
mod rows;
mod table;
mod tables;

pub use journal::Place;
pub use missing::{missing, run_trials};
pub use parquet::write_parquet;
pub use rows::trial_columns;
