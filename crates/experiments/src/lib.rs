//! The laboratory behind the command `usar`: trials in parallel, tables, records, and the trust maths alone.

pub mod calibration;
pub mod claims;
mod cli;
mod commands;
pub mod comparison;
pub mod experiment;
mod failure;
mod files;
mod input_table;
pub mod metric;
pub mod provenance;
pub mod readings;
pub mod report;
pub mod rounds;
pub mod run;
pub mod stats;
pub mod sweep;
mod table;

pub use cli::{main, main_with};
pub use failure::Failure;

/// The programs in the README compile.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
