//! Why something cannot be exported.

use thiserror::Error;

/// Why something cannot be exported.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExportError {
    /// A frame of the recording cannot be read.
    #[error(transparent)]
    Recording(#[from] recording::ReadError),
    /// It cannot be written as MCAP.
    #[error("cannot be written: {0}")]
    Mcap(#[from] ::mcap::McapError),
    /// A table cannot be written or read.
    #[error("cannot be written: {0}")]
    Csv(#[from] csv::Error),
    /// It cannot be written as Parquet.
    #[error("cannot be written: {0}")]
    Parquet(#[from] ::parquet::errors::ParquetError),
    /// It cannot be written as JSON.
    #[error("cannot be written: {0}")]
    Json(#[from] serde_json::Error),
    /// It cannot be written.
    #[error("cannot be written: {0}")]
    Write(#[from] std::io::Error),
    /// A cell of a table is not what its column holds.
    #[error("row {row}: column {column}: must be {rule}, found {found:?}")]
    Cell {
        /// The row, from 1, without the header.
        row: usize,
        /// Name of the column.
        column: String,
        /// What it must be.
        rule: &'static str,
        /// What it is.
        found: String,
    },
}
