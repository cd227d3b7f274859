//! A table of a sweep's folder. Each row begins with the values of the sweep's axes. Rows are made in
//! memory, so that threads can make them, and written to the file in order.

use std::path::Path;

use store::Failure;
use store::files::{FileHash, NewFile};

use super::column::{About, Cell, Column};
use super::rows;
use crate::experiment::Experiment;

/// A table that is being written.
pub(super) struct Table(NewFile);

impl Table {
    /// Begins a table with these columns after those of the axes.
    ///
    /// # Errors
    /// The folder cannot be written to.
    pub(super) fn new(
        folder: &Path,
        name: &str,
        experiment: &Experiment,
        columns: Vec<About>,
    ) -> Result<Self, Failure> {
        let mut header = Rows::new();
        let columns = rows::before(&experiment.axes).into_iter().chain(columns);
        header.write(columns.map(|about| about.name))?;
        let mut table = Self(NewFile::new(folder, name)?);
        table.append(header)?;
        Ok(table)
    }

    /// Adds rows.
    ///
    /// # Errors
    /// The disk does not take them.
    pub(super) fn append(&mut self, rows: Rows) -> Result<(), Failure> {
        self.0.append(&rows.0.into_inner().map_err(Failure::run)?)
    }

    /// Completes the table and gives its file its name.
    ///
    /// # Errors
    /// The disk does not take it.
    pub(super) fn finish(self) -> Result<FileHash, Failure> {
        self.0.finish()
    }
}

/// Rows of a table in memory.
pub(super) struct Rows(csv::Writer<Vec<u8>>);

/// The cells before a table's own columns in the rows of a case: its number from 1 and the values of the
/// axes; empty without axes.
pub(super) fn before(experiment: &Experiment, case: usize) -> Vec<String> {
    let values = &experiment.cases[case].values;
    let number = (!values.is_empty()).then(|| (case + 1).to_string());
    number.into_iter().chain(values.iter().cloned()).collect()
}

impl Rows {
    /// No rows.
    pub(super) fn new() -> Self {
        Self(csv::WriterBuilder::new().has_headers(false).flexible(true).from_writer(Vec::new()))
    }

    /// Adds rows.
    ///
    /// # Errors
    /// None: they can be written to memory.
    pub(super) fn add_all<R>(
        &mut self,
        before: &[String],
        columns: &[Column<R>],
        mut rows: impl Iterator<Item = R>,
    ) -> Result<(), Failure> {
        rows.try_for_each(|row| self.add(before, columns, &row))
    }

    /// Adds a row.
    ///
    /// # Errors
    /// None: it can be written to memory.
    pub(super) fn add<R>(
        &mut self,
        before: &[String],
        columns: &[Column<R>],
        row: &R,
    ) -> Result<(), Failure> {
        let cells: Vec<Cell> = columns.iter().map(|column| column.read(row)).collect();
        self.0.serialize((before, cells)).map_err(Failure::run)
    }

    fn write(&mut self, cells: impl IntoIterator<Item = String>) -> Result<(), Failure> {
        self.0.write_record(cells.into_iter().map(String::into_bytes)).map_err(Failure::run)
    }
}
