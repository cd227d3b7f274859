//! Files that get their name when they are complete, and hashes of files.

use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::{Xxh3, xxh3_128};

use crate::failure::{Failure, at};

/// Largest number of bytes of a file that is read whole.
pub const FILE_BYTES: u64 = 16 << 20;

/// A file that is being written; it gets its name when it is complete.
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

impl FileHash {
    /// The hash of a file with these bytes.
    pub fn of(name: &str, content: &[u8]) -> Self {
        Self { name: name.to_owned(), xxh3_128: format!("{:032x}", xxh3_128(content)) }
    }
}

impl NewFile {
    /// Begins a file with this name.
    ///
    /// # Errors
    /// The folder cannot be written to.
    pub fn new(folder: &Path, name: &str) -> Result<Self, Failure> {
        let path = folder.join(name);
        let file = create(&new_path(&path)).map_err(|error| trouble(&path, &error))?;
        Ok(Self { name: name.to_owned(), path, file: BufWriter::new(file), hash: Xxh3::new() })
    }

    /// Adds bytes.
    ///
    /// # Errors
    /// The disk does not take them.
    pub fn append(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        self.write_all(bytes).map_err(|error| trouble(&self.path, &error))
    }

    /// Completes the file and gives it its name.
    ///
    /// # Errors
    /// The disk does not take it. An existing file with this name is then unchanged.
    pub fn finish(self) -> Result<FileHash, Failure> {
        let Self { name, path, file, hash } = self;
        let file = file.into_inner().map_err(|error| trouble(&path, error.error()))?;
        file.sync_all()
            .and_then(|()| std::fs::rename(new_path(&path), &path))
            .map_err(|error| trouble(&path, &error))?;
        Ok(FileHash { name, xxh3_128: format!("{:032x}", hash.digest128()) })
    }

    /// Writes a whole file at once.
    ///
    /// # Errors
    /// Those of the other functions.
    pub fn write(folder: &Path, name: &str, content: &[u8]) -> Result<FileHash, Failure> {
        let mut file = Self::new(folder, name)?;
        file.append(content)?;
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

/// The temporary path of a file that is being written.
fn new_path(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{name}.new"))
}

fn trouble(path: &Path, error: &io::Error) -> Failure {
    Failure::storage(format!("cannot write {}: {error}", path.display()))
}

/// Opens a file for reading. Anything but a regular file, such as a folder, a pipe or a device, is refused
/// without waiting.
///
/// # Errors
/// The file does not exist, is not a regular file, or cannot be read.
pub fn open(path: &Path) -> io::Result<File> {
    if fs::metadata(path)?.is_file() { File::open(path) } else { Err(no_file()) }
}

/// The bytes of a file that [`open`] opens, at most [`FILE_BYTES`].
///
/// # Errors
/// Those of [`open`], or the file is larger.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(path)?.take(FILE_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 <= FILE_BYTES {
        return Ok(bytes);
    }
    let reason = format!("is larger than the {} MiB that such a file may have", FILE_BYTES >> 20);
    Err(io::Error::new(ErrorKind::FileTooLarge, reason))
}

/// Creates a file for reading and writing, and replaces an existing file with this name. No link is
/// followed.
fn create(path: &Path) -> io::Result<File> {
    remove(path)?;
    File::options().read(true).write(true).create_new(true).open(path)
}

/// Refuses to write to a path that exists and is not a regular file. A link is not a regular file.
///
/// # Errors
/// The path is something other than a regular file.
pub fn check_is_file(path: &Path) -> io::Result<()> {
    match fs::symlink_metadata(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error),
        Ok(there) if there.is_file() => Ok(()),
        Ok(_) => Err(no_file()),
    }
}

fn no_file() -> io::Error {
    io::Error::new(ErrorKind::InvalidInput, "is not a regular file")
}

/// Deletes a file if it exists. If it is a link, the link is deleted.
///
/// # Errors
/// It cannot be deleted.
pub fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// The XXH3-128 of a file's bytes in hexadecimal digits.
///
/// # Errors
/// It cannot be read.
pub fn file_hash(path: &Path) -> io::Result<String> {
    let (mut file, mut hash, mut bytes) = (open(path)?, Xxh3::new(), vec![0; 1 << 16]);
    loop {
        match file.read(&mut bytes)? {
            0 => return Ok(format!("{:032x}", hash.digest128())),
            count => hash.update(&bytes[..count]),
        }
    }
}

/// Syncs a folder to disk, and with it the names of its files.
///
/// # Errors
/// The disk refuses.
pub fn sync_folder(path: &Path) -> Result<(), Failure> {
    let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
    File::open(path).and_then(|folder| folder.sync_all()).map_err(at(path))
}
