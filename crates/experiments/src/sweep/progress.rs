//! The progress of a folder, determined without reading its trials.

use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use super::disk::read_manifest;
use super::journal;
use super::lock::{Holder, holder};
use crate::failure::Failure;
use crate::files;
use crate::provenance::Manifest;

/// The progress of a sweep or a shard.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// The manifest of the sweep.
    pub manifest: Manifest,
    /// Number of trials in its journal; 0 for a finished sweep, which is not counted.
    pub journal_lines: usize,
    /// The process that works in the folder now.
    pub holder: Option<Holder>,
}

/// The progress of a folder; `None` if no sweep has begun there.
///
/// # Errors
/// The manifest was changed or belongs to another program, or files cannot be read.
pub fn progress(folder: &Path) -> Result<Option<Progress>, Failure> {
    let Some(manifest) = read_manifest(folder)? else { return Ok(None) };
    let trouble = |error: io::Error| Failure::storage(format!("{}: {error}", folder.display()));
    let journal_lines =
        if manifest.is_complete { 0 } else { lines(&folder.join(journal::FILE)).map_err(trouble)? };
    let holder = holder(folder).map_err(trouble)?;
    Ok(Some(Progress { manifest, journal_lines, holder }))
}

/// Number of complete lines of a file; 0 if the file does not exist.
fn lines(path: &Path) -> io::Result<usize> {
    let file = match files::open(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(0),
        opened => opened?,
    };
    let (mut reader, mut lines) = (BufReader::with_capacity(1 << 16, file), 0);
    while reader.skip_until(b'\n')? > 0 {
        lines += 1;
    }
    let mut file = reader.into_inner();
    let mut last = [b'\n'];
    if lines > 0 {
        file.seek(SeekFrom::End(-1))?;
        file.read_exact(&mut last)?;
    }
    Ok(lines - usize::from(last != *b"\n"))
}
