//! `.lock`: only one process at a time works in a folder, or on a file (`.lock.NAME`).
//!
//! The lock is the system's own on that file (`flock`, which NFS since version 4 carries to its server): it
//! ends with its process, however the process ends, and no file that was left behind stands in the way. The
//! text of the file says which process holds it. Readers take no lock.

use std::fs::{self, File, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::failure::Failure;
use crate::{files, machine};

/// Name of a folder's lock.
pub const LOCK: &str = ".lock";
/// How often a lock is tried that is held: a process that looks who holds it has it for a moment.
const TRIES: u32 = 5;
/// Time between two tries.
const PAUSE: Duration = Duration::from_millis(20);
/// Largest number of bytes that are read of a lock.
const MOST_BYTES: u64 = 4_096;

/// A lock on a folder: only this process works there, until the lock is dropped.
#[derive(Debug)]
pub struct Lock {
    /// The locked file and its path; `None` where the user wants no lock.
    held: Option<(File, PathBuf)>,
}

/// The process that holds a folder.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Holder {
    /// Name of the host.
    pub host: String,
    /// The job, in Slurm's notation: `42_3` is the third task of the array 42.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub job: Option<String>,
    /// Number of the process.
    pub process: u32,
    /// When the process took the folder, in UTC.
    pub since: String,
}

impl std::fmt::Display for Holder {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let job = self.job.as_ref().map_or(String::new(), |job| format!(", job {job}"));
        write!(f, "process {} on {}{job}, since {}", self.process, self.host, self.since)
    }
}

impl Holder {
    /// This process as a holder.
    fn this() -> Self {
        let (host, job) = (machine::name(), machine::job());
        Self { host, job, process: std::process::id(), since: machine::now() }
    }
}

impl Lock {
    /// Takes a folder.
    ///
    /// # Errors
    /// Another process works in the folder, it cannot be written to, or its file system has no locks.
    pub fn of_folder(folder: &Path) -> Result<Self, Failure> {
        let busy = format!("{}: another process is at work in this folder", folder.display());
        Self::take(&folder.join(LOCK), &busy)
    }

    /// Takes a file.
    ///
    /// # Errors
    /// Another process works on the file, its folder cannot be written to, or the file system has no locks.
    pub fn of_file(path: &Path) -> Result<Self, Failure> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let busy = format!("{}: another process is at work on this file", path.display());
        Self::take(&path.with_file_name(format!("{LOCK}.{name}")), &busy)
    }

    /// No lock: the user knows that no other process writes there.
    pub fn none() -> Self {
        Self { held: None }
    }

    fn take(path: &Path, busy: &str) -> Result<Self, Failure> {
        let folder = path.parent().unwrap_or(path);
        let trouble =
            |error: io::Error| Failure::storage(format!("cannot write to {}: {error}", folder.display()));
        files::check_is_file(path).map_err(trouble)?;
        for _ in 0..TRIES {
            let file = File::options().read(true).write(true).create(true).truncate(false).open(path);
            let file = file.map_err(trouble)?;
            match file.try_lock() {
                // A holder removes its file: the lock of a removed file is nobody's.
                Ok(()) if is_at(&file, path) => return Self::hold(file, path).map_err(trouble),
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => sleep(PAUSE),
                Err(TryLockError::Error(error)) => {
                    return Err(Failure::storage(format!(
                        "{}: its file system has no locks ({error}): take a folder elsewhere, or, where no \
                         other process writes there, `usar sweep --no-lock`",
                        folder.display()
                    )));
                }
            }
        }
        let who = read(path).map_or_else(|| "it does not say which".to_owned(), |holder| holder.to_string());
        Err(Failure::storage(format!("{busy}: {who}")))
    }

    fn hold(mut file: File, path: &Path) -> io::Result<Self> {
        let text = serde_json::to_string(&Holder::this())? + "\n";
        file.set_len(0)?;
        file.rewind()?;
        file.write_all(text.as_bytes())?;
        Ok(Self { held: Some((file, path.to_owned())) })
    }
}

impl Drop for Lock {
    /// Removes the file while it is locked; the system unlocks it when it is closed.
    fn drop(&mut self) {
        if let Some((file, path)) = &self.held
            && is_at(file, path)
        {
            let _ = fs::remove_file(path);
        }
    }
}

/// Whether an open file is the one at this path.
fn is_at(file: &File, path: &Path) -> bool {
    let [own, there] =
        [file.metadata(), path.symlink_metadata()].map(|data| data.map(|of| (of.dev(), of.ino())));
    own.is_ok_and(|own| there.is_ok_and(|there| own == there))
}

/// The process that a lock names; `None` if its text was torn, or is not there.
fn read(path: &Path) -> Option<Holder> {
    let mut bytes = Vec::new();
    files::open(path).ok()?.take(MOST_BYTES).read_to_end(&mut bytes).ok()?;
    serde_json::from_slice(&bytes).ok()
}

/// Whether a file is a lock.
pub fn is_lock(name: &str) -> bool {
    name.strip_prefix(LOCK).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_process_at_a_time_has_a_folder_and_leaves_no_lock() {
        let folder = tempfile::tempdir().unwrap();
        let lock = Lock::of_folder(folder.path()).unwrap();
        let other = Lock::of_folder(folder.path()).unwrap_err().to_string();
        let expected = format!("process {} on {}", std::process::id(), machine::name());
        assert!(other.contains(&expected), "{other}");
        drop(lock);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn what_a_killed_process_has_left_stands_in_no_way() {
        let folder = tempfile::tempdir().unwrap();
        for text in
            ["", "{\"host\":\"a", "{\"host\":\"b\",\"process\":1,\"since\":\"2026-01-01T00:00:00Z\"}\n"]
        {
            fs::write(folder.path().join(LOCK), text).unwrap();
            drop(Lock::of_folder(folder.path()).unwrap());
        }
    }

    #[test]
    fn of_many_that_want_a_folder_one_at_a_time_has_it() {
        let folder = tempfile::tempdir().unwrap();
        let taken = folder.path().join("taken");
        let work = || {
            for _ in 0..200 {
                let Ok(lock) = Lock::of_folder(folder.path()) else { continue };
                let alone = File::options().write(true).create_new(true).open(&taken);
                alone.expect("no other thread is between these two lines");
                fs::remove_file(&taken).unwrap();
                drop(lock);
            }
        };
        std::thread::scope(|scope| (0..4).for_each(|_| drop(scope.spawn(work))));
    }
}
