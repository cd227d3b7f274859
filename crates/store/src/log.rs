//! A log: a header, and a line with a checksum for each entry. An interrupted job resumes from it.

use std::error::Error;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use ron_tree::without_types;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use thiserror::Error;
use xxhash_rust::xxh3::xxh3_64;

use crate::failure::{Failure, at};
use crate::files;
use crate::lock::Lock;
use crate::medium::Medium;

/// Largest number of bytes of a line.
pub const LINE_BYTES: u64 = 256 << 20;

/// Start of a line, before 16 hexadecimal digits.
const HEAD: &str = "{\"xxh3_64\":\"";
/// Text between the digits and an entry, or the header.
const ENTRY: &str = "\",\"entry\":";
const HEADER: &str = "\",\"log\":";

/// The first line of a log: the job that it belongs to.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    kind: String,
    fingerprint: String,
}

impl Header {
    /// The header of a job of this kind. `decides` is everything that decides its entries.
    pub fn new(kind: &str, decides: &str) -> Self {
        Self { kind: kind.to_owned(), fingerprint: format!("{:016x}", xxh3_64(decides.as_bytes())) }
    }

    /// The header as a line.
    pub fn line(&self) -> Vec<u8> {
        let text = format!("{{\"kind\":{:?},\"fingerprint\":{:?}}}", self.kind, self.fingerprint);
        with_checksum(HEADER, &text)
    }

    /// Refuses a first line that is not this header.
    fn check(&self, line: &[u8]) -> Result<(), LineError> {
        let there = sound(line, HEADER).and_then(|there| serde_json::from_slice(there).ok());
        let there: Self = there.ok_or(LineError::NoLog)?;
        if there.kind != self.kind {
            return Err(LineError::OtherKind { there: there.kind, now: self.kind.clone() });
        }
        if there == *self { Ok(()) } else { Err(LineError::OtherJob { kind: there.kind }) }
    }
}

/// What is wrong with a line of a log.
#[derive(Debug, Error)]
pub enum LineError {
    /// The first line is no header.
    #[error("is not a log of this program; nothing was written. Move the file away, or use another folder")]
    NoLog,
    /// The log belongs to a job of another kind.
    #[error("is the log of a {there}, not of a {now}; nothing was written. Use another folder")]
    OtherKind {
        /// Its kind.
        there: String,
        /// The kind that was expected.
        now: String,
    },
    /// The log belongs to another job.
    #[error(
        "is the log of another {kind}: its scenario, options or program differ; nothing was written. Use \
         another folder, or delete the file"
    )]
    OtherJob {
        /// The kind of both.
        kind: String,
    },
    /// The line is not what was written.
    #[error("the checksum does not match: the line was changed. Without the line, its work is done again")]
    Changed,
    /// The line has no end within the limit.
    #[error("is longer than {} MiB", LINE_BYTES >> 20)]
    Long,
    /// The entry cannot be used.
    #[error("{0}. Without the line, its work is done again")]
    Entry(Box<dyn Error>),
}

/// A sound line of a log.
pub struct Line<'a> {
    /// Its first byte in the file.
    pub start: u64,
    /// Its number of bytes.
    pub size: usize,
    /// Its entry, as JSON.
    pub entry: &'a [u8],
}

/// A log. It is written under a lock.
pub struct Log<M = File> {
    path: PathBuf,
    file: M,
    /// Length of the sound part, in bytes.
    length: u64,
    /// Whether the file may be longer than its sound part.
    is_torn: bool,
    /// Held as long as the log is open; absent if it was opened for reading.
    _lock: Option<Arc<Lock>>,
}

/// The line of an entry.
///
/// # Errors
/// The entry cannot be written as JSON.
pub fn checked(entry: &impl Serialize) -> Result<Vec<u8>, Failure> {
    Ok(with_checksum(ENTRY, &serde_json::to_string(entry).map_err(Failure::run)?))
}

/// The entry of a line, if its checksum matches.
pub fn entry_of(line: &[u8]) -> Option<&[u8]> {
    sound(line, ENTRY)
}

fn with_checksum(middle: &str, text: &str) -> Vec<u8> {
    format!("{HEAD}{:016x}{middle}{text}}}\n", xxh3_64(text.as_bytes())).into_bytes()
}

fn sound<'a>(line: &'a [u8], middle: &str) -> Option<&'a [u8]> {
    let (digits, rest) = line.strip_prefix(HEAD.as_bytes())?.split_at_checked(16)?;
    let text = rest.strip_prefix(middle.as_bytes())?.strip_suffix(b"}\n")?;
    (digits == format!("{:016x}", xxh3_64(text)).as_bytes()).then_some(text)
}

/// The entries of a log, without writing to it. An incomplete last line, which a process may be writing, is
/// ignored. A missing file has no entries.
///
/// # Errors
/// The file cannot be read, is not the log of this job, or was changed.
pub fn read<T: DeserializeOwned>(path: &Path, header: &Header) -> Result<Vec<T>, Failure> {
    let mut entries = Vec::new();
    if path.symlink_metadata().is_ok() {
        Log::view(path, header, collect(&mut entries))?;
    }
    Ok(entries)
}

fn collect<T: DeserializeOwned>(entries: &mut Vec<T>) -> impl FnMut(&Line) -> Result<(), Box<dyn Error>> {
    |line| {
        entries.push(serde_json::from_slice(line.entry).map_err(|error| without_types(&error))?);
        Ok(())
    }
}

impl Log {
    /// Opens a log to add entries, or begins it, and returns its entries.
    ///
    /// # Errors
    /// Those of [`Log::open`].
    pub fn resume<T: DeserializeOwned>(
        path: &Path,
        header: &Header,
        lock: Arc<Lock>,
    ) -> Result<(Self, Vec<T>), Failure> {
        let mut entries = Vec::new();
        let log = Self::open(path, header, lock, collect(&mut entries))?;
        Ok((log, entries))
    }

    /// Opens a log to add entries, or begins it, and hands each of its lines to `found`. An incomplete last
    /// line is the one that a killed process was writing; it is removed.
    ///
    /// # Errors
    /// The file is not the log of this job, was changed, or cannot be written. `found` refuses a line.
    pub fn open(
        path: &Path,
        header: &Header,
        lock: Arc<Lock>,
        found: impl FnMut(&Line) -> Result<(), Box<dyn Error>>,
    ) -> Result<Self, Failure> {
        files::check_is_file(path).map_err(at(path))?;
        let mut options = File::options();
        let file =
            options.read(true).write(true).create(true).truncate(false).open(path).map_err(at(path))?;
        files::sync_folder(path.parent().unwrap_or(path))?;
        let log = Log { path: path.to_owned(), file, length: 0, is_torn: true, _lock: Some(lock) };
        log.begin(header, found)
    }

    /// Opens a log to read it, and hands each of its lines to `found`. An incomplete last line, which a
    /// process may be writing, is ignored.
    ///
    /// # Errors
    /// The file is not the log of this job, was changed, or cannot be read. `found` refuses a line.
    pub fn view(
        path: &Path,
        header: &Header,
        found: impl FnMut(&Line) -> Result<(), Box<dyn Error>>,
    ) -> Result<Self, Failure> {
        let file = files::open(path).map_err(at(path))?;
        let mut log = Log { path: path.to_owned(), file, length: 0, is_torn: true, _lock: None };
        log.scan(header, found)?;
        Ok(log)
    }
}

impl<M: Medium> Log<M> {
    /// Opens a log on something other than a file, without a lock. `name` stands in messages.
    ///
    /// # Errors
    /// Those of [`Log::open`].
    pub fn on(
        medium: M,
        name: &Path,
        header: &Header,
        found: impl FnMut(&Line) -> Result<(), Box<dyn Error>>,
    ) -> Result<Self, Failure> {
        let log = Self { path: name.to_owned(), file: medium, length: 0, is_torn: true, _lock: None };
        log.begin(header, found)
    }

    fn begin(
        mut self,
        header: &Header,
        found: impl FnMut(&Line) -> Result<(), Box<dyn Error>>,
    ) -> Result<Self, Failure> {
        self.scan(header, found)?;
        if self.length == 0 {
            self.append(&header.line())?;
        } else {
            self.mend().map_err(at(&self.path))?;
        }
        Ok(self)
    }

    /// Reads all complete lines, and finds the length of the sound part.
    fn scan(
        &mut self,
        header: &Header,
        mut found: impl FnMut(&Line) -> Result<(), Box<dyn Error>>,
    ) -> Result<(), Failure> {
        let mut reader = BufReader::new(&mut self.file);
        let mut bytes = Vec::new();
        for number in 1.. {
            bytes.clear();
            let read = reader.by_ref().take(LINE_BYTES).read_until(b'\n', &mut bytes);
            let size = read.map_err(at(&self.path))?;
            let is_whole = bytes.last() == Some(&b'\n');
            let checked = if !is_whole && size as u64 == LINE_BYTES {
                Err(LineError::Long)
            } else if number == 1 && (is_whole || !header.line().starts_with(&bytes)) {
                header.check(&bytes)
            } else if !is_whole {
                return Ok(());
            } else {
                let entry = sound(&bytes, ENTRY).ok_or(LineError::Changed);
                entry.and_then(|entry| {
                    found(&Line { start: self.length, size, entry }).map_err(LineError::Entry)
                })
            };
            checked.map_err(|error| Failure::input(format!("{}:{number}: {error}", self.path.display())))?;
            self.length += size as u64;
        }
        Ok(())
    }

    /// Cuts the file to its sound part.
    fn mend(&mut self) -> io::Result<()> {
        self.file.cut(self.length)?;
        self.is_torn = false;
        Ok(())
    }

    /// Adds entries. They are on disk when this returns.
    ///
    /// # Errors
    /// The disk does not take them. The log is then unchanged.
    pub fn add(&mut self, entries: &[impl Serialize]) -> Result<(), Failure> {
        let lines = entries.iter().map(checked).collect::<Result<Vec<_>, _>>()?;
        self.append(&lines.concat()).map(drop)
    }

    /// Adds lines that [`checked`] made, and returns the place of the first. They are on disk when this
    /// returns.
    ///
    /// # Errors
    /// Those of [`Log::add`].
    pub fn append(&mut self, lines: &[u8]) -> Result<u64, Failure> {
        let start = self.length;
        let mut write = || {
            if self.is_torn {
                self.mend()?;
            }
            self.file.seek(SeekFrom::Start(start))?;
            self.is_torn = true;
            self.file.write_all(lines)?;
            self.file.sync()
        };
        if let Err(error) = write() {
            let _ = self.mend(); // or before the next line
            return Err(at(&self.path)(error));
        }
        self.is_torn = false;
        self.length += lines.len() as u64;
        Ok(start)
    }

    /// A line, by its place and its number of bytes.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn line(&mut self, start: u64, size: usize) -> Result<Vec<u8>, Failure> {
        let mut line = vec![0; size];
        let read = self.file.seek(SeekFrom::Start(start)).and_then(|_| self.file.read_exact(&mut line));
        read.map(|()| line).map_err(at(&self.path))
    }
}
