//! `.lock`: one process at a time works in a folder, also on file systems that nodes share.
//!
//! The file is made with `O_EXCL`, which every file system does as one step, and names host, job, process and
//! time. Where the system call `flock` works, its holder has it as well, so that a killed process of the same
//! machine leaves nothing behind; on Lustre without `flock`, and on NFS with locks of each node alone, the
//! file is what counts. Its holder writes it anew every `BEAT`. A lock is stale, and is taken over with a
//! note, when
//!
//! - it is of this host, and its process is gone, or
//! - it is of an earlier start of this very job (Slurm requeued it), or
//! - it was not written for `STALE`, by the clock of the file server.

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime};

use serde::{Deserialize, Serialize};

use super::disk::LOCK;
use super::host;
use crate::failure::Failure;
use crate::files;

/// How often a holder writes its lock anew.
const BEAT: Duration = Duration::from_secs(30);
/// The silence after which the lock of another host is stale.
const STALE: Duration = Duration::from_mins(5);
/// The silence after which a lock is stale that says nothing: its process was killed while it was making it.
const UNSAID: Duration = Duration::from_secs(10);
/// Bytes of a lock that are read.
const MOST_BYTES: u64 = 4_096;

/// A folder that this process alone works in, until it is dropped.
#[derive(Debug)]
pub struct Lock {
    held: Arc<Held>,
    /// Dropping it ends the thread.
    end: Option<Sender<()>>,
    beats: Option<JoinHandle<()>>,
}

/// What holds a folder.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Holder {
    /// Name of its host.
    pub host: String,
    /// Its job, as Slurm names it: `42_3` is the third task of the array 42.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub job: Option<String>,
    /// How often this job was requeued before.
    #[serde(default)]
    pub restarts: u32,
    /// Number of its process.
    pub process: u32,
    /// When it took the folder, in UTC.
    pub since: String,
}

impl std::fmt::Display for Holder {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let job = self.job.as_ref().map_or(String::new(), |job| format!(", job {job}"));
        write!(f, "process {} on {}{job}, since {}", self.process, self.host, self.since)
    }
}

impl Holder {
    /// This process.
    fn this() -> Self {
        Self {
            host: host::name(),
            job: host::job(),
            restarts: host::variable("SLURM_RESTART_COUNT").and_then(|text| text.parse().ok()).unwrap_or(0),
            process: std::process::id(),
            since: host::now(),
        }
    }
}

/// What is known of a lock that is there.
struct Found {
    holder: Option<Holder>,
    /// Whether `flock` says that no process of this host has it; `None` where it cannot be asked.
    is_free: Option<bool>,
    /// Time since it was written.
    silence: Duration,
}

impl Found {
    /// Why it may be taken over, or nothing.
    fn stale(&self, this: &Holder) -> Option<&'static str> {
        let Some(holder) = &self.holder else {
            return (self.is_free != Some(false) && self.silence > UNSAID).then_some("it says nothing");
        };
        let is_here = holder.host == this.host;
        if self.is_free == Some(false) {
            None
        } else if is_here && (self.is_free == Some(true) || !host::is_running(holder.process)) {
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
    /// Takes a folder; what is to be said about it goes to `say`.
    ///
    /// # Errors
    /// Another process is at work in it, or it cannot be written to.
    pub fn take(folder: &Path, say: &mut dyn FnMut(String)) -> Result<Self, Failure> {
        let path = folder.join(LOCK);
        let trouble =
            |error: io::Error| Failure::storage(format!("cannot write to {}: {error}", folder.display()));
        files::check_is_file(&path).map_err(trouble)?;
        let this = Holder::this();
        // Once more after a stale lock is gone, and after one that was given back while we looked.
        for _ in 0..3 {
            match File::options().read(true).write(true).create_new(true).open(&path) {
                Ok(file) => return Self::hold(file, &path, &this).map_err(trouble),
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(trouble(error)),
            }
            let Some((found, bytes, _flock)) = look(&path).map_err(trouble)? else { continue };
            let who = found.holder.as_ref().map_or("a process".to_owned(), Holder::to_string);
            let Some(why) = found.stale(&this) else {
                return Err(Failure::storage(format!(
                    "{}: another process is at work in this folder: {who}",
                    folder.display()
                )));
            };
            if remove_stale(&path, &bytes).map_err(trouble)? && found.holder.is_some() {
                say(format!("{}: the lock of {who} is taken over: {why}", folder.display()));
            }
        }
        Err(Failure::storage(format!("{}: another process is at work in this folder", folder.display())))
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

    /// Refuses to go on when another process has taken the folder over, because this one was silent for too
    /// long.
    ///
    /// # Errors
    /// That.
    pub fn check(&self) -> Result<(), Failure> {
        let state = self.held.state.lock().unwrap_or_else(PoisonError::into_inner);
        let is_late = state.latest.elapsed().is_ok_and(|silence| silence > 2 * BEAT);
        let was_lost = state.is_lost;
        drop(state);
        if was_lost || is_late && !self.held.beat() {
            let path = self.held.path.display();
            return Err(Failure::storage(format!(
                "{path}: was taken over by another process while this one was silent; the same command goes on"
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
    /// When the lock was written last, by the clock of this host.
    latest: SystemTime,
    is_lost: bool,
}

impl Held {
    fn is_ours(&self) -> bool {
        read(&self.path).is_ok_and(|bytes| bytes == self.text.as_bytes())
    }

    /// Writes the lock anew; returns whether it is still ours.
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

/// What is known of a lock, with its bytes and, for as long as the file is open, its `flock`; nothing where
/// it is gone.
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

/// Time since a file was written, by the clock of its file server: that of a file that is written now.
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

/// Removes a lock with these bytes; returns whether it was that lock. One that took its place in between is
/// put back.
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

/// A name beside the lock that no other process has.
fn beside(path: &Path, what: &str) -> PathBuf {
    path.with_file_name(format!("{LOCK}.{what}-{}-{}", host::name(), std::process::id()))
}

/// What holds a folder, if anything does that was not silent for too long.
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
