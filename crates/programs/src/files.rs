//! By what results know a program: what it says of itself, and the files that decide its answers.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use glob::{MatchOptions, Pattern};
use sha2::{Digest, Sha256};
use walkdir::WalkDir;
use xxhash_rust::xxh3::xxh3_64;

use crate::error::Complaint;
use crate::options::Options;
use crate::protocol::Greeting;

/// Most files that decide the answers of a program.
pub(crate) const MOST_FILES: usize = 1_000;

/// Most bytes of these files together.
pub(crate) const MOST_BYTES: u64 = 256 << 20;

/// Most entries of folders that are looked at for them.
pub(crate) const MOST_ENTRIES: usize = 100_000;

/// `*` stands for no separator of folders, and `**` for any folders.
const MATCHING: MatchOptions = MatchOptions {
    case_sensitive: true,
    require_literal_separator: true,
    require_literal_leading_dot: false,
};

/// The files that decide the answers of a program: the words of its command that are files, and those that
/// `sources` names. Links are not followed.
fn files(options: &Options, stop: &AtomicBool) -> Result<BTreeSet<PathBuf>, Complaint> {
    let words = options.command.iter().map(PathBuf::from);
    let mut files: BTreeSet<PathBuf> = words.filter(|word| word.is_file()).collect();
    let mut looked_at = 0;
    for text in &options.sources {
        let Ok(pattern) = Pattern::new(text.trim_start_matches("./")) else { continue }; // it was checked
        let mut has_some = false;
        for entry in entries(text) {
            looked_at += 1;
            if stop.load(Ordering::Relaxed) {
                return Err(Complaint::Stopped);
            }
            if looked_at > MOST_ENTRIES {
                return Err(Complaint::Sources {
                    pattern: text.clone(),
                    most: MOST_ENTRIES,
                    what: "entries of folders",
                });
            }
            let path = entry.path().strip_prefix(".").unwrap_or(entry.path());
            if entry.file_type().is_file() && pattern.matches_path_with(path, MATCHING) {
                has_some = true;
                files.insert(path.to_owned());
            }
            if files.len() > MOST_FILES {
                return Err(Complaint::Sources { pattern: text.clone(), most: MOST_FILES, what: "files" });
            }
        }
        if !has_some {
            return Err(Complaint::NoSource(text.clone()));
        }
    }
    if files.len() > MOST_FILES {
        let pattern = options.command.join(" ");
        return Err(Complaint::Sources { pattern, most: MOST_FILES, what: "files" });
    }
    Ok(files)
}

/// What is in the folders that a pattern names, no deeper than the pattern reaches.
fn entries(pattern: &str) -> impl Iterator<Item = walkdir::DirEntry> {
    let is_plain = |part: &&OsStr| !part.to_string_lossy().contains(['*', '?', '[']);
    let parts: Vec<&OsStr> = Path::new(pattern).iter().collect();
    let plain = parts.iter().take(parts.len().saturating_sub(1)).take_while(|part| is_plain(part)).count();
    let folder = Path::new(".").join(parts[..plain].iter().collect::<PathBuf>());
    let is_link = folder.ancestors().any(Path::is_symlink);
    let deepest = if pattern.contains("**") { usize::MAX } else { parts.len() - plain };
    let walk = (!is_link).then(|| WalkDir::new(folder).max_depth(deepest).sort_by_file_name());
    walk.into_iter().flatten().flatten()
}

/// Calls a function with the path and the bytes of each file that decides answers. No more is read of a file
/// than the system says that it has: files without an end have no length.
fn read_each(
    options: &Options,
    stop: &AtomicBool,
    mut each: impl FnMut(&Path, &[u8]),
) -> Result<(), Complaint> {
    let mut left = MOST_BYTES;
    for path in files(options, stop)? {
        let unreadable = |error: std::io::Error| Complaint::Unreadable {
            path: path.display().to_string(),
            reason: error.to_string(),
        };
        let file = File::open(&path).map_err(unreadable)?;
        let length = file.metadata().map_err(unreadable)?.len();
        left = left.checked_sub(length).ok_or(Complaint::LargeSources)?;
        let mut bytes = Vec::new();
        file.take(length).read_to_end(&mut bytes).map_err(unreadable)?;
        each(&path, &bytes);
        if stop.load(Ordering::Relaxed) {
            return Err(Complaint::Stopped);
        }
    }
    Ok(())
}

/// A hash of the names and contents of the files that decide answers, which nobody can forge.
pub(crate) fn seal(options: &Options, stop: &AtomicBool) -> Result<Sha256, Complaint> {
    let mut seal = Sha256::new();
    read_each(options, stop, |path, bytes| {
        let name = path.as_os_str().as_encoded_bytes();
        for part in [name, bytes] {
            seal.update((part.len() as u64).to_le_bytes());
            seal.update(part);
        }
    })?;
    Ok(seal)
}

/// A text that changes whenever the answers of a program may change.
pub(crate) fn fingerprint(
    options: &Options,
    greeting: &Greeting,
    stop: &AtomicBool,
) -> Result<String, Complaint> {
    let mut hashes = Vec::new();
    read_each(options, stop, |path, bytes| {
        hashes.push(format!("{}={:016x}", path.display(), xxh3_64(bytes)));
    })?;
    let (Greeting { name, version, .. }, files) = (greeting, hashes.join(", "));
    Ok(format!("{name} {version}; protocol {}; files [{files}]", env!("SOURCES_PROGRAMS")))
}
