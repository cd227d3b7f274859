//! Rows of a table as CSV.

use std::io::{self, Write};

use csv::{Writer, WriterBuilder};

use crate::column::{About, Cell, Column};

/// A table that is being written as CSV.
pub struct Csv<W: Write>(Writer<W>);

impl<W: Write> Csv<W> {
    /// A table without rows.
    pub fn new(out: W) -> Self {
        Self(WriterBuilder::new().has_headers(false).flexible(true).from_writer(out))
    }

    /// Writes the names of the columns.
    ///
    /// # Errors
    /// The output does not take them.
    pub fn add_names(&mut self, columns: &[About]) -> io::Result<()> {
        Ok(self.0.write_record(columns.iter().map(|about| &about.name))?)
    }

    /// Adds rows, each with the cells `before` in front of its own.
    ///
    /// # Errors
    /// The output does not take them.
    pub fn add<R>(
        &mut self,
        before: &[String],
        columns: &[Column<R>],
        mut rows: impl Iterator<Item = R>,
    ) -> io::Result<()> {
        rows.try_for_each(|row| {
            let cells: Vec<Cell> = columns.iter().map(|column| column.read(&row)).collect();
            Ok(self.0.serialize((before, cells))?)
        })
    }

    /// Returns the output when everything is written.
    ///
    /// # Errors
    /// The output does not take the rest.
    pub fn finish(self) -> io::Result<W> {
        self.0.into_inner().map_err(csv::IntoInnerError::into_error)
    }
}
