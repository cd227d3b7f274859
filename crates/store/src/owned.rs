//! Owned folders: a job writes only to a folder that is its own, or empty.

use std::fs;
use std::path::Path;

use crate::failure::{Failure, at};
use crate::lock;

/// The names in a folder, sorted.
///
/// # Errors
/// The folder cannot be read.
pub fn names_in(folder: &Path) -> Result<Vec<String>, Failure> {
    let entries = fs::read_dir(folder).map_err(at(folder))?.flatten();
    let mut names: Vec<String> =
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    Ok(names)
}

/// Refuses a folder with files, unless `is_owned`. Locks, and files that a killed process left incomplete,
/// are nobody's. `noun` is the job in messages.
///
/// # Errors
/// The folder belongs to something else, or is none.
pub fn check_is_owned(folder: &Path, noun: &str, is_owned: bool) -> Result<(), Failure> {
    if !folder.exists() {
        return Ok(());
    }
    if !folder.is_dir() {
        return Err(Failure::input(format!("--out: {} is a file, not a folder", folder.display())));
    }
    let is_nobodys = |name: &String| lock::is_lock(name) || name.strip_suffix(".new").is_some();
    if is_owned || names_in(folder)?.iter().all(is_nobodys) {
        return Ok(());
    }
    Err(Failure::input(format!(
        "--out: {} is not empty and not the folder of a {noun}; nothing was overwritten",
        folder.display()
    )))
}
