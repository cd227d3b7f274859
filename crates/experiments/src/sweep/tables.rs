//! Tables of a sweep's folder as files: a row for each thing, the axes of the sweep before its own columns, and a hash of all bytes.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use xxhash_rust::xxh3::Xxh3;

use crate::failure::Failure;

/// A file on its way: it takes its name when it is whole.
pub struct NewFile {
    name: String,
    path: PathBuf,
    file: BufWriter<File>,
    hash: Xxh3,
}

/// A file that is on disk, with the XXH3-128 of its bytes in hexadecimal digits.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, serde::Deserialize)]
pub struct FileHash {
    /// Its name.
    pub name: String,
    /// The hash.
    pub xxh3_128: String,
}

impl NewFile {
    /// Begins a file of this name.
    ///
    /// # Errors
    /// The folder cannot be written to.
    pub fn new(folder: &Path, name: &str) -> Result<Self, Failure> {
        let path = folder.join(name);
        let file = File::create(new_path(&path)).map_err(|error| trouble(&path, &error))?;
        Ok(Self { name: name.to_owned(), path, file: BufWriter::new(file), hash: Xxh3::new() })
    }

    /// Puts the file in its place.
    ///
    /// # Errors
    /// The disk does not take it; a file of this name that was there is as it was.
    pub fn finish(self) -> Result<FileHash, Failure> {
        let Self { name, path, file, hash } = self;
        let file = file.into_inner().map_err(|error| trouble(&path, error.error()))?;
        file.sync_all()
            .and_then(|()| std::fs::rename(new_path(&path), &path))
            .map_err(|error| trouble(&path, &error))?;
        Ok(FileHash { name, xxh3_128: format!("{:032x}", hash.digest128()) })
    }

    /// A whole file at once.
    ///
    /// # Errors
    /// Those of the other functions.
    pub fn write(folder: &Path, name: &str, content: &[u8]) -> Result<FileHash, Failure> {
        let mut file = Self::new(folder, name)?;
        file.write_all(content).map_err(|error| trouble(&folder.join(name), &error))?;
        file.finish()
    }
}

impl Write for NewFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.hash.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Where a file is until it is whole.
fn new_path(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{name}.new"))
}

fn trouble(path: &Path, error: &io::Error) -> Failure {
    Failure::storage(format!("cannot write {}: {error}", path.display()))
}

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
        self.add_record(case, &header.iter().collect::<Vec<_>>(), row.iter())
    }

    /// Adds a row of a case as texts.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn add_record<'t>(
        &mut self,
        (case, values): (usize, &'t [String]),
        header: &[&str],
        row: impl Iterator<Item = &'t str>,
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

    fn write_header(&mut self, header: &[&str]) -> Result<(), Failure> {
        if std::mem::replace(&mut self.has_header, true) {
            return Ok(());
        }
        let before = if self.axes.is_empty() { None } else { Some("case") };
        let before = before.into_iter().chain(self.axes.iter().map(String::as_str));
        let header = before.chain(header.iter().copied());
        self.writer.write_record(header).map_err(|error| table_trouble(&self.path, &error))
    }

    /// Puts the table in its place; one without rows has its header all the same.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn finish(mut self, header: &[impl AsRef<str>]) -> Result<FileHash, Failure> {
        let header: Vec<&str> = header.iter().map(AsRef::as_ref).collect();
        self.write_header(&header)?;
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
