//! Files that take their name when they are whole, and the hashes of their bytes.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
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
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
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

pub(crate) fn trouble(path: &Path, error: &io::Error) -> Failure {
    Failure::storage(format!("cannot write {}: {error}", path.display()))
}

struct HashWriter(Xxh3);

impl std::io::Write for HashWriter {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// The XXH3-128 of a file's bytes in hexadecimal digits.
///
/// # Errors
/// It cannot be read.
pub(crate) fn file_hash(path: &Path) -> std::io::Result<String> {
    let mut hash = HashWriter(Xxh3::new());
    std::io::copy(&mut File::open(path)?, &mut hash)?;
    Ok(format!("{:032x}", hash.0.digest128()))
}
