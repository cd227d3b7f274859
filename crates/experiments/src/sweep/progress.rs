//! The progress of a folder, determined without reading its trials.

use std::path::Path;

use store::lock::{Holder, holder};
use store::{Failure, at, count};

use super::disk::read_manifest;
use super::journal;
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
    let journal_lines =
        if manifest.is_complete { 0 } else { count(&folder.join(journal::FILE)).map_err(at(folder))? };
    let holder = holder(folder).map_err(at(folder))?;
    Ok(Some(Progress { manifest, journal_lines, holder }))
}
