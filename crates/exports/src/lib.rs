//! Exports recordings of trials for other programs: as MCAP logs for robot viewers, and as tidy tables.
//!
//! [`mcap`](mod@mcap) writes a log for Foxglove and Lichtblick. [`tables`] writes the time series of
//! robots and groups, events and decisions as CSV. [`parquet`] converts any such table to a Parquet file.

mod error;
pub mod mcap;
pub mod parquet;
pub mod tables;

pub use error::ExportError;
