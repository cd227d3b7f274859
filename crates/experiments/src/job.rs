//! Jobs in folders of their own: a file that says what the job is, and the log of what is done. An
//! interrupted job resumes from it.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::sync::Arc;

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

/// A list in a job's origin that may grow from run to run.
const GROWS: &str = "seeds";

impl Job {
    /// Opens the log of a new job, or of one to resume; returns its entries and its origin, whose list of
    /// seeds is the longer one. `is_fresh` starts over.
    ///
    /// # Errors
    /// The folder belongs to something else, another process works there, or the disk does not take it.
    pub fn open<T: DeserializeOwned>(
        &self,
        folder: &Path,
        mut origin: Value,
        is_fresh: bool,
    ) -> Result<(Log, Vec<T>, Value), Failure> {
        let is_owned = folder.join(self.origin).is_file();
        check_is_owned(folder, self.noun, is_owned)?;
        fs::create_dir_all(folder).map_err(at(folder))?;
        let lock = Lock::of_folder(folder, &mut |_| {})?;
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
        Ok((log, entries, origin))
    }

    /// The origin and the entries of the job in a folder. The program that ran it may be another one.
    ///
    /// # Errors
    /// It is not the folder of such a job, or the log was changed.
    pub fn read<T: DeserializeOwned>(&self, folder: &Path) -> Result<(Value, Vec<T>), Failure> {
        let origin = self.origin_in(folder)?;
        let entries = store::read(&folder.join(self.log), &self.header(&origin))?;
        Ok((origin, entries))
    }

    fn origin_in(&self, folder: &Path) -> Result<Value, Failure> {
        let path = folder.join(self.origin);
        let text = files::read(&path).map_err(|error| {
            let (folder, noun) = (folder.display(), self.noun);
            Failure::input(format!("{folder}: is not the folder of a {noun}: {}: {error}", self.origin))
        })?;
        serde_json::from_slice(&text).map_err(|error| {
            Failure::input(format!("{}: {error}; --out takes another folder", path.display()))
        })
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
