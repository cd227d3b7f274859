//! A table of a sweep's folder: a row for each thing, the axes of the sweep before its own columns.

use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::failure::Failure;
use crate::files::{FileHash, NewFile, trouble};

/// A table whose columns are those of the serialised rows, after the number of the case and the values of the axes where there are any.
pub struct Table {
    writer: csv::Writer<NewFile>,
    axes: Vec<String>,
    has_header: bool,
    path: PathBuf,
}

impl Table {
    /// Begins a table.
    ///
    /// # Errors
    /// The folder cannot be written to.
    pub fn new(folder: &Path, name: &str, axes: Vec<String>) -> Result<Self, Failure> {
        let writer = csv::Writer::from_writer(NewFile::new(folder, name)?);
        Ok(Self { writer, axes, has_header: false, path: folder.join(name) })
    }

    /// Adds a row of a case.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn add<R: Serialize>(&mut self, case: (usize, &[String]), row: &R) -> Result<(), Failure> {
        if self.axes.is_empty() {
            self.has_header = true;
            return self.writer.serialize(row).map_err(|error| table_trouble(&self.path, &error));
        }
        let [header, row] = header_and_row(row)?;
        self.add_record(case, &header.iter().collect::<Vec<_>>(), &row)
    }

    /// Adds a row of a case as texts.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn add_record(
        &mut self,
        (case, values): (usize, &[String]),
        header: &[impl AsRef<str>],
        row: impl IntoIterator<Item = impl AsRef<str>>,
    ) -> Result<(), Failure> {
        self.write_header(header)?;
        let mut record = csv::StringRecord::new();
        if !self.axes.is_empty() {
            record.push_field(&(case + 1).to_string());
        }
        record.extend(values);
        record.extend(row);
        self.writer.write_record(&record).map_err(|error| table_trouble(&self.path, &error))
    }

    fn write_header(&mut self, header: &[impl AsRef<str>]) -> Result<(), Failure> {
        if std::mem::replace(&mut self.has_header, true) {
            return Ok(());
        }
        let before = if self.axes.is_empty() { None } else { Some("case") };
        let before = before.into_iter().chain(self.axes.iter().map(String::as_str));
        let header = before.chain(header.iter().map(AsRef::as_ref));
        self.writer.write_record(header).map_err(|error| table_trouble(&self.path, &error))
    }

    /// Puts the table in its place; one without rows has its header all the same.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn finish(mut self, header: &[impl AsRef<str>]) -> Result<FileHash, Failure> {
        self.write_header(header)?;
        let Self { writer, path, .. } = self;
        let file = writer.into_inner().map_err(|error| trouble(&path, error.error()))?;
        file.finish()
    }
}

fn table_trouble(path: &Path, error: &csv::Error) -> Failure {
    Failure::storage(format!("cannot write {}: {error}", path.display()))
}

/// The names of the columns of a row.
///
/// # Errors
/// None: rows can be written to memory.
pub fn columns<R: Serialize + Default>() -> Result<Vec<String>, Failure> {
    let [header, _] = header_and_row(&R::default())?;
    Ok(header.iter().map(str::to_owned).collect())
}

fn header_and_row(row: &impl Serialize) -> Result<[csv::StringRecord; 2], Failure> {
    let mut rows = csv::Writer::from_writer(Vec::new());
    rows.serialize(row).map_err(Failure::run)?;
    let bytes = rows.into_inner().map_err(Failure::run)?;
    let mut rows = csv::ReaderBuilder::new().has_headers(false).from_reader(&*bytes).into_records();
    let mut next = || rows.next().transpose().map_err(Failure::run).map(Option::unwrap_or_default);
    Ok([next()?, next()?])
}
