//! Exports results for other programs: recordings of trials as MCAP logs for robot viewers
//! ([`mcap`](mod@mcap)), and tables as Parquet files ([`parquet`]).

mod error;
pub mod mcap;
pub mod parquet;

pub use error::ExportError;
