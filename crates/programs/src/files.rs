//! By what results know a program: what it says of itself, and the files that decide its answers.

use std::collections::BTreeSet;
use std::path::PathBuf;

use xxhash_rust::xxh3::xxh3_64;

use crate::error::Complaint;
use crate::options::Options;
use crate::protocol::Greeting;

/// The files that decide the answers of a program: the words of its command that are files, and those that
/// `sources` names.
pub(crate) fn files(options: &Options) -> Result<BTreeSet<PathBuf>, Complaint> {
    let words = options.command.iter().map(PathBuf::from);
    let mut files: BTreeSet<PathBuf> = words.filter(|word| word.is_file()).collect();
    for pattern in &options.sources {
        let found = glob::glob(pattern).ok().into_iter().flatten().flatten();
        let before = files.len();
        let found: Vec<PathBuf> = found.filter(|path| path.is_file()).collect();
        let is_known = found.iter().any(|path| files.contains(path));
        files.extend(found);
        if files.len() == before && !is_known {
            return Err(Complaint::NoSource(pattern.clone()));
        }
    }
    Ok(files)
}

/// A text that changes whenever the answers of a program may change.
pub(crate) fn fingerprint(options: &Options, greeting: &Greeting) -> Result<String, Complaint> {
    let mut hashes = Vec::new();
    for path in files(options)? {
        let bytes = std::fs::read(&path).map_err(|error| Complaint::Unreadable {
            path: path.display().to_string(),
            reason: error.to_string(),
        })?;
        hashes.push(format!("{}={:016x}", path.display(), xxh3_64(&bytes)));
    }
    let Greeting { name, version, .. } = greeting;
    Ok(format!("{name} {version}; protocol {}; files [{}]", env!("SOURCES_PROGRAMS"), hashes.join(", ")))
}
