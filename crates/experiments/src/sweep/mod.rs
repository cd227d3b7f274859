//! Where the results of a sweep are kept: its folder, its journal, and the tables made of it.

pub mod disk;
pub mod folder;
mod journal;
pub mod links;
mod rows;
mod table;
mod tables;

pub use journal::Place;
pub(crate) use rows::trial_columns;
