//! How far a folder is, without reading its trials.

use std::io::{self, Read};
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

/// The lines of a file; 0 where there is none.
fn lines(path: &Path) -> io::Result<usize> {
    let mut file = match files::open(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(0),
        opened => opened?,
    };
    let (mut buffer, mut lines) = (vec![0; 1 << 16], 0);
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(lines),
            size => lines += buffer[..size].iter().filter(|byte| **byte == b'\n').count(),
        }
    }
}
