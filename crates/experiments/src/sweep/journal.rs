//! `journal.jsonl`: each trial is on disk as soon as it ends, as a line of JSON with its checksum.
//! Everything else in a sweep's folder is made from it.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::line::{Finished, HEAD, finished_of, policy_of};
use crate::experiment::{Experiment, Place, Shard};
use crate::failure::Failure;
use crate::files;
use crate::limits::JOURNAL_LINE_BYTES;
use crate::run::FaultKind;

/// Name of the file.
pub const FILE: &str = "journal.jsonl";

/// The journal of a sweep's folder.
pub(super) struct Journal {
    path: PathBuf,
    file: File,
    /// Length of the sound part, in bytes.
    length: u64,
    /// Offset and size of each finished trial's line.
    lines: BTreeMap<Place, (u64, usize)>,
}

/// A line that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Damage {
    /// File, line and defect.
    pub what: String,
    /// Whether it is the last line and lacks its end.
    pub is_cut_off: bool,
}

/// Removes the trials of these policies from the journal of a folder. Returns how many there were of each
/// that had any.
///
/// # Errors
/// The file cannot be read, or the disk does not take the new one. The journal is then unchanged.
pub(super) fn without(folder: &Path, policies: &[String]) -> Result<BTreeMap<String, usize>, Failure> {
    let path = folder.join(FILE);
    let mut removed = BTreeMap::new();
    if policies.is_empty() || path.symlink_metadata().is_err() {
        return Ok(removed);
    }
    let trouble = |error: std::io::Error| Failure::storage(format!("{}: {error}", path.display()));
    let new = folder.join(format!("{FILE}.new"));
    let mut kept = BufWriter::new(files::create(&new).map_err(trouble)?);
    let mut lines = BufReader::new(files::open(&path).map_err(trouble)?);
    let mut line = Vec::new();
    while lines.by_ref().take(JOURNAL_LINE_BYTES.most as u64).read_until(b'\n', &mut line).map_err(trouble)?
        > 0
    {
        match policy_of(&line).filter(|policy| policies.contains(policy)) {
            Some(policy) => *removed.entry(policy).or_default() += 1,
            None => kept.write_all(&line).map_err(trouble)?,
        }
        line.clear();
    }
    let kept = kept.into_inner().map_err(|error| trouble(error.into_error()))?;
    kept.sync_all().and_then(|()| std::fs::rename(&new, &path)).map_err(trouble)?;
    files::sync_folder(folder)?;
    Ok(removed)
}

/// Whether a folder has a journal of this program.
pub(super) fn is_one(folder: &Path) -> bool {
    let mut head = [0; HEAD.len()];
    let read = files::open(&folder.join(FILE)).and_then(|mut file| file.read_exact(&mut head));
    read.is_ok() && head == *HEAD.as_bytes()
}

impl Journal {
    /// Opens the journal of a folder, for the whole sweep or one shard, and hands each finished trial to
    /// `found`, in the order of the file. If the journal is writable, trials that timed out count as not
    /// run. An incomplete last line is the one that a killed process was writing.
    ///
    /// # Errors
    /// The file cannot be read.
    pub(super) fn open(
        folder: &Path,
        experiment: &Experiment,
        shard: Option<Shard>,
        is_writable: bool,
        mut found: impl FnMut(Finished),
    ) -> Result<(Self, Vec<Damage>), Failure> {
        let path = folder.join(FILE);
        let trouble = |error| Failure::storage(format!("{}: {error}", path.display()));
        files::check_is_file(&path).map_err(trouble)?;
        let mut options = OpenOptions::new();
        options.read(true).write(is_writable).create(is_writable);
        let file = options.open(&path).map_err(trouble)?;
        if is_writable {
            File::open(folder).and_then(|folder| folder.sync_all()).map_err(trouble)?;
        }
        let mut reader = BufReader::new(&file);
        let (mut length, mut lines, mut damages) = (0, BTreeMap::new(), Vec::new());
        let mut line = Vec::new();
        for number in 1.. {
            line.clear();
            let most = JOURNAL_LINE_BYTES.most as u64;
            let size = reader.by_ref().take(most).read_until(b'\n', &mut line).map_err(trouble)?;
            if size == 0 {
                break;
            }
            if size as u64 == most && line.last() != Some(&b'\n') {
                let reason = format!("line {number} is longer than {} MiB", most >> 20);
                return Err(trouble(std::io::Error::new(std::io::ErrorKind::InvalidData, reason)));
            }
            if line.last() != Some(&b'\n') {
                let what = format!("{}:{number}: the last line is cut off", path.display());
                damages.push(Damage { what, is_cut_off: true });
                break;
            }
            match finished_of(&line, experiment, shard) {
                Ok(finished) => {
                    let timed_out =
                        matches!(&finished.result, Err(fault) if fault.kind == FaultKind::TimedOut);
                    if !(timed_out && is_writable) {
                        lines.insert(finished.place(), (length, size));
                        found(finished);
                    }
                }
                Err(reason) => {
                    let what = format!("{}:{number}: {reason}", path.display());
                    damages.push(Damage { what, is_cut_off: false });
                }
            }
            length += size as u64;
        }
        Ok((Self { path, file, length, lines }, damages))
    }

    /// Adds lines. They are on disk when this returns.
    ///
    /// # Errors
    /// The disk does not take them. The journal is then unchanged.
    pub(super) fn append(&mut self, added: &[(Place, Vec<u8>)]) -> Result<(), Failure> {
        let bytes: Vec<u8> = added.iter().flat_map(|(_, line)| line).copied().collect();
        let mut write = || {
            self.file.seek(SeekFrom::Start(self.length))?;
            self.file.write_all(&bytes)?;
            self.file.set_len(self.length + bytes.len() as u64)?;
            self.file.sync_data()
        };
        if let Err(error) = write() {
            let _ = self.file.set_len(self.length);
            return Err(Failure::storage(format!("{}: {error}", self.path.display())));
        }
        for (place, line) in added {
            self.lines.insert(*place, (self.length, line.len()));
            self.length += line.len() as u64;
        }
        Ok(())
    }

    /// The line of a finished trial.
    ///
    /// # Errors
    /// The file cannot be read.
    pub(super) fn line(&mut self, place: Place) -> Result<Vec<u8>, Failure> {
        let no_such = || Failure::storage(format!("{}: has no such trial", self.path.display()));
        let (start, size) = self.lines.get(&place).copied().ok_or_else(no_such)?;
        let mut line = vec![0; size];
        let read = self.file.seek(SeekFrom::Start(start)).and_then(|_| self.file.read_exact(&mut line));
        read.map_err(|error| Failure::storage(format!("{}: {error}", self.path.display())))?;
        Ok(line)
    }
}
