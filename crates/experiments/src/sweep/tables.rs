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
    pub fn add<R: Serialize>(&mut self, (case, values): (usize, &[String]), row: &R) -> Result<(), Failure> {
        let trouble =
            |error: csv::Error| Failure::storage(format!("cannot write {}: {error}", self.path.display()));
        if self.axes.is_empty() {
            return self.writer.serialize(row).map_err(trouble);
        }
        let mut rows = csv::Writer::from_writer(Vec::new());
        rows.serialize(row).map_err(trouble)?;
        let bytes = rows.into_inner().map_err(Failure::run)?;
        let mut rows = csv::ReaderBuilder::new().has_headers(false).from_reader(&*bytes).into_records();
        let mut next = || rows.next().transpose().map_err(trouble);
        let (header, row) = (next()?, next()?);
        if !self.has_header {
            self.has_header = true;
            let before = std::iter::once("case").chain(self.axes.iter().map(String::as_str));
            let header = header.iter().flat_map(csv::StringRecord::iter);
            self.writer.write_record(before.chain(header)).map_err(trouble)?;
        }
        let case = (case + 1).to_string();
        let before = std::iter::once(case.as_str()).chain(values.iter().map(String::as_str));
        self.writer.write_record(before.chain(row.iter().flat_map(csv::StringRecord::iter))).map_err(trouble)
    }

    /// Puts the table in its place.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn finish(self) -> Result<FileHash, Failure> {
        let Self { writer, path, .. } = self;
        let file = writer.into_inner().map_err(|error| trouble(&path, error.error()))?;
        file.finish()
    }
}
