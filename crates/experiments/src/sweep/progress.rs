//! How far a folder is, without reading its trials.

use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use super::disk::read_manifest;
use super::journal;
use super::lock::{Holder, holder};
use crate::failure::Failure;
use crate::files;
use crate::provenance::Manifest;

/// How far a sweep or a shard is.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// What it is of.
    pub manifest: Manifest,
    /// Trials that are in its journal; of a finished one this is not counted.
    pub journal_lines: usize,
    /// What works in it now.
    pub holder: Option<Holder>,
}

/// How far a folder is; nothing where no sweep has begun there.
///
/// # Errors
/// Its manifest was changed or is another program's, or its files cannot be read.
pub fn progress(folder: &Path) -> Result<Option<Progress>, Failure> {
    let Some(manifest) = read_manifest(folder)? else { return Ok(None) };
    let trouble = |error: io::Error| Failure::storage(format!("{}: {error}", folder.display()));
    let journal_lines =
        if manifest.is_complete { 0 } else { lines(&folder.join(journal::FILE)).map_err(trouble)? };
    let holder = holder(folder).map_err(trouble)?;
    Ok(Some(Progress { manifest, journal_lines, holder }))
}

/// The lines of a file that have an end; 0 where there is none.
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
