//! Why an export failed.

use thiserror::Error;

/// Why an export failed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExportError {
    /// A frame of the recording cannot be read.
    #[error(transparent)]
    Recording(#[from] recording::ReadError),
    /// The MCAP log cannot be written.
    #[error("cannot be written: {0}")]
    Mcap(#[from] ::mcap::McapError),
    /// A message cannot be encoded.
    #[error("cannot be written: {0}")]
    Message(String),
    /// A table cannot be written or read.
    #[error("cannot be written: {0}")]
    Csv(#[from] csv::Error),
    /// The Parquet file cannot be written.
    #[error("cannot be written: {0}")]
    Parquet(#[from] ::parquet::errors::ParquetError),
    /// The JSON cannot be written.
    #[error("cannot be written: {0}")]
    Json(#[from] serde_json::Error),
    /// The output cannot be written.
    #[error("cannot be written: {0}")]
    Write(#[from] std::io::Error),
    /// A cell of a table does not match its column's kind.
    #[error("row {row}: column {column}: must be {rule}, found {found:?}")]
    Cell {
        /// The row, from 1, without the header.
        row: usize,
        /// Name of the column.
        column: String,
        /// The rule for the cell.
        rule: &'static str,
        /// The content of the cell.
        found: String,
    },
}
