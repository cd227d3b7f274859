//! `.lock`: only one process at a time works in a folder, or on a file (`.lock.NAME`), also on file systems
//! that nodes share.
//!
//! The file is created with `O_EXCL`, which every file system does atomically. It names host, job, process
//! and time. Where the system call `flock` works, the holder also has that lock, so that a killed process
//! of the same machine leaves no lock behind. On Lustre without `flock`, and on NFS with locks local to
//! each node, only the file counts. The holder rewrites the file every `BEAT`. A lock is stale, and is
//! taken over with a note, if
//!
//! - its host is this one and its process is gone, or
//! - it belongs to an earlier start of this very job (Slurm requeued it), or
//! - it has not been written for `STALE`, by the clock of the file server.

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime};

use serde::{Deserialize, Serialize};

use crate::failure::Failure;
use crate::{files, machine};

/// Name of a folder's lock.
pub const LOCK: &str = ".lock";
/// How often a holder rewrites its lock.
const BEAT: Duration = Duration::from_secs(30);
/// Time without writing after which a lock is stale, unless `flock` shows that it is held.
const STALE: Duration = Duration::from_mins(5);
/// Time without writing after which an empty or unreadable lock is stale: its process was killed while
/// creating it.
const UNSAID: Duration = Duration::from_secs(10);
/// Largest number of bytes that are read of a lock.
const MOST_BYTES: u64 = 4_096;

/// A lock on a folder: only this process works there, until the lock is dropped.
#[derive(Debug)]
pub struct Lock {
    held: Arc<Held>,
    /// Dropping the sender ends the thread.
    end: Option<Sender<()>>,
    beats: Option<JoinHandle<()>>,
}

/// The process that holds a folder.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Holder {
    /// Name of the host.
    pub host: String,
    /// The job, in Slurm's notation: `42_3` is the third task of the array 42.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub job: Option<String>,
    /// How often this job was requeued before.
    #[serde(default)]
    pub restarts: u32,
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
        Self {
            host: machine::name(),
            job: machine::job(),
            restarts: machine::variable("SLURM_RESTART_COUNT")
                .and_then(|text| text.parse().ok())
                .unwrap_or(0),
            process: std::process::id(),
            since: machine::now(),
        }
    }
}

/// State of an existing lock.
struct Found {
    holder: Option<Holder>,
    /// Whether no process of this host has the `flock`; `None` if `flock` does not work.
    is_free: Option<bool>,
    /// Time since it was written.
    silence: Duration,
}

impl Found {
    /// The reason why the lock may be taken over; `None` if it may not.
    fn stale(&self, this: &Holder) -> Option<&'static str> {
        let Some(holder) = &self.holder else {
            return (self.is_free != Some(false) && self.silence > UNSAID).then_some("it says nothing");
        };
        let is_here = holder.host == this.host;
        if self.is_free == Some(false) {
            None
        } else if is_here && (self.is_free == Some(true) || !machine::is_running(holder.process)) {
            Some("that process is gone")
        } else if holder.job.is_some() && holder.job == this.job && holder.restarts < this.restarts {
            Some("the job was requeued")
        } else if self.silence > STALE {
            Some("it was silent for five minutes")
        } else {
            None
        }
    }
}

impl Lock {
    /// Takes a folder. Messages go to `say`.
    ///
    /// # Errors
    /// Another process works in the folder, or it cannot be written to.
    pub fn of_folder(folder: &Path, say: &mut dyn FnMut(String)) -> Result<Self, Failure> {
        let busy = format!("{}: another process is at work in this folder", folder.display());
        Self::take(&folder.join(LOCK), &busy, say)
    }

    /// Takes a file. Messages go to `say`.
    ///
    /// # Errors
    /// Another process works on the file, or its folder cannot be written to.
    pub fn of_file(path: &Path, say: &mut dyn FnMut(String)) -> Result<Self, Failure> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let busy = format!("{}: another process is at work on this file", path.display());
        Self::take(&path.with_file_name(format!("{LOCK}.{name}")), &busy, say)
    }

    fn take(path: &Path, busy: &str, say: &mut dyn FnMut(String)) -> Result<Self, Failure> {
        let folder = path.parent().unwrap_or(path);
        let trouble =
            |error: io::Error| Failure::storage(format!("cannot write to {}: {error}", folder.display()));
        files::check_is_file(path).map_err(trouble)?;
        let this = Holder::this();
        // Tries again after removing a stale lock, and after a lock that its holder released in the
        // meantime.
        for _ in 0..3 {
            match File::options().read(true).write(true).create_new(true).open(path) {
                Ok(file) => return Self::hold(file, path, &this).map_err(trouble),
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(trouble(error)),
            }
            let Some((found, bytes, _flock)) = look(path).map_err(trouble)? else { continue };
            let who = found.holder.as_ref().map_or("a process".to_owned(), Holder::to_string);
            let Some(why) = found.stale(&this) else {
                return Err(Failure::storage(format!("{busy}: {who}")));
            };
            if remove_stale(path, &bytes).map_err(trouble)? && found.holder.is_some() {
                say(format!("{}: the lock of {who} is taken over: {why}", folder.display()));
            }
        }
        Err(Failure::storage(busy))
    }

    fn hold(mut file: File, path: &Path, this: &Holder) -> io::Result<Self> {
        let _ = file.try_lock(); // where it does not work, the file alone counts
        let text = serde_json::to_string(this)? + "\n";
        file.write_all(text.as_bytes())?;
        file.sync_all()?;
        let state = State { file, latest: SystemTime::now(), is_lost: false };
        let held = Arc::new(Held { path: path.to_owned(), text, state: Mutex::new(state) });
        let (end, ended) = channel::<()>();
        let beating = Arc::clone(&held);
        let beats = std::thread::Builder::new().name("lock".into()).spawn(move || {
            while ended.recv_timeout(BEAT) == Err(std::sync::mpsc::RecvTimeoutError::Timeout) {
                beating.beat();
            }
        })?;
        Ok(Self { held, end: Some(end), beats: Some(beats) })
    }

    /// Fails if another process has taken over the folder, because this process did not write its lock for
    /// too long.
    ///
    /// # Errors
    /// The folder was taken over.
    pub fn check(&self) -> Result<(), Failure> {
        let state = self.held.state.lock().unwrap_or_else(PoisonError::into_inner);
        let is_late = state.latest.elapsed().is_ok_and(|silence| silence > 2 * BEAT);
        let was_lost = state.is_lost;
        drop(state);
        if was_lost || is_late && !self.held.beat() {
            let path = self.held.path.display();
            return Err(Failure::storage(format!(
                "{path}: was taken over by another process while this one was silent; the same command goes \
                 on"
            )));
        }
        Ok(())
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        self.end = None;
        if let Some(beats) = self.beats.take() {
            let _ = beats.join();
        }
        if self.held.is_ours() {
            let _ = fs::remove_file(&self.held.path);
        }
    }
}

#[derive(Debug)]
struct Held {
    path: PathBuf,
    text: String,
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    file: File,
    /// When the lock was last written, by the clock of this host.
    latest: SystemTime,
    is_lost: bool,
}

impl Held {
    fn is_ours(&self) -> bool {
        read(&self.path).is_ok_and(|bytes| bytes == self.text.as_bytes())
    }

    /// Rewrites the lock; returns whether it is still ours.
    fn beat(&self) -> bool {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if !self.is_ours() {
            state.is_lost = true;
            return false;
        }
        let file = &mut state.file;
        let written = file.seek(SeekFrom::Start(0)).and_then(|_| file.write_all(self.text.as_bytes()));
        if written.and_then(|()| state.file.sync_data()).is_ok() {
            state.latest = SystemTime::now();
        }
        true
    }
}

fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    files::open(path)?.take(MOST_BYTES).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// What is known about a lock, with its bytes and the opened file, which holds the `flock` until it is
/// closed. `None` if the lock is gone.
fn look(path: &Path) -> io::Result<Option<(Found, Vec<u8>, File)>> {
    let opened = match File::options().read(true).append(true).open(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        opened => opened?,
    };
    let is_free = match opened.try_lock() {
        Ok(()) => Some(true),
        Err(TryLockError::WouldBlock) => Some(false),
        Err(TryLockError::Error(_)) => None,
    };
    let bytes = match read(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        read => read?,
    };
    let Some(silence) = silence(path, &opened)? else { return Ok(None) };
    let holder = serde_json::from_slice(&bytes).ok();
    Ok(Some((Found { holder, is_free, silence }, bytes, opened)))
}

/// Time since a file was written, by the clock of its file server: compared with a file that is written
/// now.
fn silence(path: &Path, file: &File) -> io::Result<Option<Duration>> {
    let probe = beside(path, "probe");
    let now = File::create(&probe).and_then(|mut new| {
        new.write_all(b"x")?;
        new.sync_all()?;
        new.metadata()?.modified()
    });
    files::remove(&probe)?;
    let written = file.metadata()?.modified()?;
    Ok(Some(now?.duration_since(written).unwrap_or_default()))
}

/// Removes a lock with these bytes; returns whether it was that lock. If another lock has taken its place
/// in the meantime, that lock is put back.
fn remove_stale(path: &Path, bytes: &[u8]) -> io::Result<bool> {
    let aside = beside(path, "stale");
    match fs::rename(path, &aside) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(false),
        renamed => renamed?,
    }
    let is_stale = read(&aside)? == bytes;
    if !is_stale {
        let _ = fs::hard_link(&aside, path);
    }
    files::remove(&aside)?;
    Ok(is_stale)
}

/// A file name beside the lock that no other process uses.
fn beside(path: &Path, what: &str) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{name}.{what}-{}-{}", machine::name(), std::process::id()))
}

/// Whether a file is a lock, or a temporary file of a process that examined a lock.
pub fn is_lock(name: &str) -> bool {
    name.strip_prefix(LOCK).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// The process that holds a folder; `None` if there is no lock or it is stale.
///
/// # Errors
/// The lock cannot be read.
pub fn holder(folder: &Path) -> io::Result<Option<Holder>> {
    let path = folder.join(LOCK);
    if path.symlink_metadata().is_err() {
        return Ok(None);
    }
    let Some((found, ..)) = look(&path)? else { return Ok(None) };
    let is_held = found.stale(&Holder::this()).is_none();
    Ok(found.holder.filter(|_| is_held))
}

#[cfg(test)]
mod tests;
