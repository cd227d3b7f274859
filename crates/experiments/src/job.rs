//! Jobs in folders of their own: a file that says what the job is, and the log of what is done. An
//! interrupted job resumes from it.

use std::collections::BTreeSet;
use std::fmt::Display;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use store::files::{self, NewFile};
use store::lock::Lock;
use store::owned::check_is_owned;
use store::{Failure, Header, Log, at};

use crate::provenance::scenario_differences;

/// What a job calls its own in its folder.
#[derive(Debug, Clone, Copy)]
pub struct Job {
    /// Its name in messages: `calibration`.
    pub noun: &'static str,
    /// Name of the file that says what decides its entries.
    pub origin: &'static str,
    /// Name of its log.
    pub log: &'static str,
    /// Names of the files that are made from the log in the end.
    pub results: &'static [&'static str],
}

/// The folder of a job.
pub struct JobFolder<T> {
    /// Its path.
    pub path: PathBuf,
    /// What decides its entries.
    pub origin: Value,
    /// What is done, in the order of the log.
    pub entries: Vec<T>,
    /// Absent if the folder was opened for reading.
    log: Option<Log>,
}

/// A list in a job's origin that may grow from run to run.
const GROWS: &str = "seeds";

impl<T: Serialize + DeserializeOwned> JobFolder<T> {
    /// Adds what was done. It is on disk when this returns.
    ///
    /// # Errors
    /// The disk does not take it, or the folder was opened for reading.
    pub fn add(&mut self, entries: Vec<T>) -> Result<(), Failure> {
        let log = self.log.as_mut().ok_or_else(|| Failure::run("the folder was opened for reading"))?;
        log.add(&entries)?;
        self.entries.extend(entries);
        Ok(())
    }
}

/// The message after an interruption: what is in the folder.
pub fn interrupted(folder: &Path, what: impl Display) -> Failure {
    let folder = folder.display();
    Failure::Interrupted(format!("stopped; {what} in {folder}, and the same command goes on"))
}

impl Job {
    /// Opens the folder of a new job, or of one to resume, whose list of seeds becomes the longer one.
    /// `is_fresh` starts over.
    ///
    /// # Errors
    /// The folder belongs to something else, another process works there, or the disk does not take it.
    pub fn open<T: DeserializeOwned>(
        &self,
        folder: &Path,
        mut origin: Value,
        is_fresh: bool,
    ) -> Result<JobFolder<T>, Failure> {
        let is_owned = folder.join(self.origin).is_file();
        check_is_owned(folder, self.noun, is_owned)?;
        fs::create_dir_all(folder).map_err(at(folder))?;
        let lock = Lock::of_folder(folder)?;
        if is_owned && !is_fresh {
            let there = self.origin_in(folder)?;
            self.check_continues(folder, &there, &origin)?;
            if there[GROWS].as_array().map(Vec::len) > origin[GROWS].as_array().map(Vec::len) {
                origin = there;
            }
        }
        if is_fresh {
            let mut own = self.results.iter().chain([&self.log]);
            own.try_for_each(|name| files::remove(&folder.join(name))).map_err(at(folder))?;
        }
        NewFile::write(folder, self.origin, format!("{origin:#}\n").as_bytes())?;
        let (log, entries) = Log::resume(&folder.join(self.log), &self.header(&origin), Arc::new(lock))?;
        Ok(JobFolder { path: folder.to_owned(), origin, entries, log: Some(log) })
    }

    /// Reads the folder of a job. The program that ran it may be another one.
    ///
    /// # Errors
    /// It is not the folder of such a job, or the log was changed.
    pub fn read<T: DeserializeOwned>(&self, folder: &Path) -> Result<JobFolder<T>, Failure> {
        let origin = self.origin_in(folder)?;
        let entries = store::read(&folder.join(self.log), &self.header(&origin))?;
        Ok(JobFolder { path: folder.to_owned(), origin, entries, log: None })
    }

    fn origin_in(&self, folder: &Path) -> Result<Value, Failure> {
        let path = folder.join(self.origin);
        let text = files::read(&path).map_err(|error| self.is_none(folder, error))?;
        serde_json::from_slice(&text).map_err(|error| {
            Failure::input(format!("{}: {error}; --out takes another folder", path.display()))
        })
    }

    /// The failure of a folder that is none of such a job.
    pub fn is_none(&self, folder: &Path, reason: impl Display) -> Failure {
        let (folder, noun) = (folder.display(), self.noun);
        Failure::input(format!("{folder}: is not the folder of a {noun}: {}: {reason}", self.origin))
    }

    fn header(&self, origin: &Value) -> Header {
        let mut decides = origin.clone();
        decides.as_object_mut().map(|decides| decides.remove(GROWS));
        Header::new(self.noun, &decides.to_string())
    }

    fn check_continues(&self, folder: &Path, there: &Value, now: &Value) -> Result<(), Failure> {
        let mut differences = Vec::new();
        for (key, value) in now.as_object().into_iter().flatten().filter(|(key, _)| *key != "scenario") {
            if !(key == GROWS && grows(&there[key], value)) {
                differences.extend(differences_of(key, &there[key], value));
            }
        }
        let text = |origin: &Value| origin["scenario"].as_str().unwrap_or_default().to_owned();
        differences.extend(scenario_differences(&text(there), &text(now)));
        if differences.is_empty() {
            return Ok(());
        }
        Err(Failure::input(format!(
            "{} has the {} of something else; --out takes another folder:\n  {}",
            folder.display(),
            self.noun,
            differences.join("\n  ")
        )))
    }
}

/// Whether one list begins with the other.
fn grows(a: &Value, b: &Value) -> bool {
    let lists = a.as_array().zip(b.as_array());
    lists.is_some_and(|(a, b)| a.iter().zip(b).all(|(a, b)| a == b))
}

/// The differences between two values, entry by entry for objects.
fn differences_of(name: &str, there: &Value, now: &Value) -> Vec<String> {
    match (there.as_object(), now.as_object()) {
        (Some(old), Some(new)) => {
            let keys: BTreeSet<&String> = old.keys().chain(new.keys()).collect();
            let inside = |key: &String| {
                differences_of(&format!("{name}.{key}"), &there[key.as_str()], &now[key.as_str()])
            };
            keys.into_iter().flat_map(inside).collect()
        }
        _ if there == now => Vec::new(),
        _ => vec![format!("{name}: {there} there, {now} now")],
    }
}
