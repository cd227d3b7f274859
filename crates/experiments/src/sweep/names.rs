//! The names of the files in a sweep's folder, and how such a folder is known.

use std::fs;
use std::path::{Path, PathBuf};

use store::files;

use super::dictionary::DICTIONARY;

/// What the folder holds, with the hashes of its files.
pub(super) const MANIFEST: &str = "manifest.json";
/// The file that was run.
pub(super) const GIVEN: &str = "experiment.ron";
/// The scenario with all that is set in it.
pub(super) const RESOLVED: &str = "resolved.ron";
/// The sweep as a file for the resolved scenario: running it reproduces the folder.
pub(super) const AGAIN: &str = "sweep.ron";
/// Files that are written before the trials.
pub(super) const INPUTS: [&str; 5] = [GIVEN, RESOLVED, AGAIN, DICTIONARY[0], DICTIONARY[1]];
/// The report; [`PLOTS`] is the folder of its figures.
pub const REPORT: &str = "report.html";
/// See [`REPORT`].
pub const PLOTS: &str = "plots";
/// The folder of recordings of trials.
pub const RECORDINGS: &str = "recordings";

/// Whether a folder holds a sweep. The program that made it may be another one, and the manifest damaged.
pub fn is_sweeps(path: &Path) -> bool {
    let manifest = files::read(&path.join(MANIFEST)).unwrap_or_default();
    String::from_utf8_lossy(&manifest).contains("\"program\": \"usar\"")
}

/// The folders inside a folder that hold sweeps, by name.
pub fn sweeps_in(path: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut sweeps: Vec<PathBuf> = entries.filter(|entry| is_sweeps(entry)).collect();
    sweeps.sort();
    sweeps
}
