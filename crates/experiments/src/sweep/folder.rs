//! The folder of a sweep's results: resumable at any moment, and the same bytes in the end.
//!
//! `journal.jsonl` takes each trial as it is done; when all are done, the tables are made from it. The manifest says what the sweep is from
//! the first moment on, so that the same command goes on with it and another is refused.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::dictionary::write_dictionary;
use super::disk::{
    MANIFEST, broken_files, check_continues, experiment_of, has_begun, lock, read_manifest, sweeps_in,
    sync_folder, write_manifest, write_start,
};
use super::journal::{self, Damage, Journal, Place};
use super::ours::{check_is_ours, check_may_be_cleared, clear};
use super::tables::Tables;
use crate::experiment::{Experiment, Shard};
use crate::failure::Failure;
use crate::files::{FileHash, check_is_file, file_hash};
use crate::metric::Catalogue;
use crate::provenance::{Manifest, SCHEMA_VERSION};
use crate::run::{Outcome, TrialKey};

/// Damaged lines of a journal that are named.
const MAX_DAMAGES: usize = 5;

/// A sweep's folder with what is finished in it.
pub struct Folder {
    path: PathBuf,
    experiment: Arc<Experiment>,
    manifest: Manifest,
    journal: Journal,
    results: BTreeMap<Place, Measured>,
    /// Held until the folder is dropped.
    _lock: Option<File>,
}

/// What comparisons need of a trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Its status in one word.
    pub status: &'static str,
    /// Values of all metrics, in the order of the experiment's catalogue; `None` for a trial without numbers.
    pub metrics: Option<Vec<Option<f64>>>,
    /// Why it gave nothing.
    pub failure: Option<String>,
}

impl Measured {
    fn of(outcome: &Outcome, metrics: &Catalogue) -> Self {
        let metrics = outcome.record().map(|record| metrics.measure(record));
        Self { status: outcome.status(), metrics, failure: outcome.failure() }
    }
}

/// How a folder is opened to be written.
#[derive(Debug, Clone, Copy, Default)]
pub struct Opening {
    /// The part of the sweep to run.
    pub shard: Option<Shard>,
    /// Start over: what is there of another sweep is deleted.
    pub is_fresh: bool,
}

impl Folder {
    /// Opens the folder of a new sweep, or of one that was broken off or is to be extended. What is to be said about it goes to `say`.
    ///
    /// # Errors
    /// It belongs to something else; the folder cannot be used; another process uses it.
    pub fn open(
        path: &Path,
        experiment: Arc<Experiment>,
        opening: Opening,
        say: &mut dyn FnMut(String),
    ) -> Result<Self, Failure> {
        check_is_ours(path)?;
        let trouble = |error| Failure::storage(format!("cannot write to {}: {error}", path.display()));
        fs::create_dir_all(path).map_err(trouble)?;
        path.parent().map_or(Ok(()), sync_folder)?;
        let lock = lock(path)?;
        if opening.is_fresh {
            check_may_be_cleared(path)?;
            clear(path).map_err(trouble)?;
        }
        let manifest = Manifest::new(&experiment, opening.shard, Vec::new());
        let mut finished = None;
        let file = path.join(journal::FILE);
        check_is_file(&file).map_err(|error| Failure::storage(format!("{}: {error}", file.display())))?;
        let has_begun = has_begun(path);
        if let Some(there) = read_manifest(path)?.filter(|_| has_begun) {
            check_continues(path, &there, &manifest, &experiment.base.resolved())?;
            let broken = broken_files(path, &there);
            for name in &broken {
                let name = path.join(name);
                say(format!(
                    "{}: does not have the checksum of the manifest; it is made again",
                    name.display()
                ));
            }
            let is_same = there.is_complete && there.started() == manifest;
            finished = (is_same && broken.is_empty()).then_some(there);
        } else if has_begun {
            return Err(Failure::storage(format!(
                "{}: has a journal but no {MANIFEST}, so what it is of is not known; --fresh starts over",
                path.display()
            )));
        }
        if let Some(manifest) = finished {
            let mut damaged = false;
            let mut note = |_| damaged = true; // it is said below
            let folder = Self::with_journal(path, Arc::clone(&experiment), manifest, true, &mut note)?;
            let missing = folder.experiment.keys(opening.shard).any(|key| !folder.has(&key));
            if !damaged && !missing {
                return Ok(Self { _lock: Some(lock), ..folder });
            }
        }
        // What the journal is of is on disk before the journal.
        let manifest = write_start(path, &experiment, opening.shard)?;
        let folder = Self::with_journal(path, experiment, manifest, true, &mut |damage| say(again(damage)))?;
        Ok(Self { _lock: Some(lock), ..folder })
    }

    /// Reads a folder, complete or not.
    ///
    /// # Errors
    /// It is not the folder of a sweep, or its files are damaged.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let (folder, damages) = Self::read_damaged(path)?;
        if damages.is_empty() { Ok(folder) } else { Err(Failure::input(damages.join("\n"))) }
    }

    /// Reads a folder as far as it is sound, and says what of it is damaged.
    ///
    /// # Errors
    /// It is not the folder of a sweep.
    pub fn read_damaged(path: &Path) -> Result<(Self, Vec<String>), Failure> {
        let not_one = |reason: &dyn std::fmt::Display| {
            Failure::input(format!("{}: is not the folder of a sweep: {reason}", path.display()))
        };
        if !path.is_dir() {
            return Err(not_one(&"there is no such folder"));
        }
        let missing = || match sweeps_in(path) {
            sweeps if sweeps.is_empty() => not_one(&format!("{MANIFEST} is missing")),
            sweeps => not_one(&format!("these in it are: {}", sweeps.join(", "))),
        };
        let manifest = read_manifest(path)?.ok_or_else(missing)?;
        if manifest.schema_version != SCHEMA_VERSION {
            return Err(not_one(&format!(
                "its layout has version {}; this program reads version {SCHEMA_VERSION}",
                manifest.schema_version
            )));
        }
        let experiment = Arc::new(experiment_of(path, &manifest)?);
        let broken = broken_files(path, &manifest);
        let mut damages = Vec::new();
        let folder =
            Self::with_journal(path, experiment, manifest, false, &mut |damage| damages.push(damage))?;
        if !broken.is_empty() {
            damages.push(format!(
                "{}: these files do not have the checksums of the manifest: {}; the sweep's command makes them again",
                path.display(),
                broken.join(", ")
            ));
        }
        Ok((folder, damages))
    }

    fn with_journal(
        path: &Path,
        experiment: Arc<Experiment>,
        manifest: Manifest,
        is_writable: bool,
        say: &mut dyn FnMut(String),
    ) -> Result<Self, Failure> {
        let mut results = BTreeMap::new();
        let (journal, damages) =
            Journal::open(path, (&experiment, manifest.shard), is_writable, |outcome| {
                let TrialKey { case, policy, trial, .. } = outcome.key;
                results.insert((case, policy, trial), Measured::of(&outcome, &experiment.metrics));
            })?;
        // A sweep that is under way may be writing its last line.
        let may_write = !is_writable && !manifest.is_complete;
        let damages: Vec<Damage> =
            damages.into_iter().filter(|damage| !(may_write && damage.is_cut_off)).collect();
        let count = damages.len();
        damages.into_iter().take(MAX_DAMAGES).for_each(|damage| say(damage.what));
        if count > MAX_DAMAGES {
            say(format!("{}: {} further lines cannot be used", path.display(), count - MAX_DAMAGES));
        }
        Ok(Self { path: path.to_owned(), experiment, manifest, journal, results, _lock: None })
    }

    /// Goes on with more trials of the same sweep.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn extend(&mut self, experiment: Arc<Experiment>) -> Result<(), Failure> {
        self.manifest = write_start(&self.path, &experiment, self.manifest.shard)?;
        self.experiment = experiment;
        Ok(())
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What it is of.
    #[must_use]
    pub fn experiment(&self) -> &Experiment {
        &self.experiment
    }

    /// What it is of, to share with threads.
    #[must_use]
    pub fn shared_experiment(&self) -> Arc<Experiment> {
        Arc::clone(&self.experiment)
    }

    /// Its manifest.
    #[must_use]
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// What is finished, by place.
    #[must_use]
    pub fn results(&self) -> &BTreeMap<Place, Measured> {
        &self.results
    }

    /// The finished trials of one case and policy, in their order.
    #[must_use]
    pub fn places(&self, case: usize, policy: usize) -> Vec<Place> {
        self.results.range((case, policy, 0)..=(case, policy, u32::MAX)).map(|(place, _)| *place).collect()
    }

    /// The values of a metric under one case and policy, as far as trials ran to their end and it is defined.
    #[must_use]
    pub fn values(&self, case: usize, policy: usize, metric: usize) -> Vec<f64> {
        let trials = self.results.range((case, policy, 0)..=(case, policy, u32::MAX));
        let measured = trials.filter_map(|(_, Measured { metrics, .. })| metrics.as_ref());
        measured.filter_map(|metrics| metrics[metric]).collect()
    }

    /// Whether a trial is finished.
    #[must_use]
    pub fn has(&self, key: &TrialKey) -> bool {
        self.journal.has(key)
    }

    /// A finished trial.
    ///
    /// # Errors
    /// The journal cannot be read.
    pub fn outcome(&mut self, place: Place) -> Result<Outcome, Failure> {
        self.journal.outcome(place, &self.experiment)
    }

    /// Its line in the journal.
    ///
    /// # Errors
    /// The journal cannot be read.
    pub fn line(&mut self, place: Place) -> Result<Vec<u8>, Failure> {
        self.journal.line(place)
    }

    /// Whether its journal is nothing but its trials, in order.
    ///
    /// # Errors
    /// The journal cannot be looked at.
    pub fn is_tidy(&self) -> Result<bool, Failure> {
        self.journal.is_tidy()
    }

    /// Takes a trial: when this returns, it is on disk.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn add(&mut self, outcome: &Outcome) -> Result<(), Failure> {
        self.journal.add(&self.experiment, outcome)?;
        let TrialKey { case, policy, trial, .. } = outcome.key;
        self.results.insert((case, policy, trial), Measured::of(outcome, &self.experiment.metrics));
        Ok(())
    }

    /// Takes the line of a trial from another folder.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn add_line(&mut self, line: &[u8], place: Place, measured: Measured) -> Result<(), Failure> {
        self.journal.append(line, place)?;
        self.results.insert(place, measured);
        Ok(())
    }

    /// What is to be said when the sweep was stopped.
    #[must_use]
    pub fn interrupted(&self) -> Failure {
        let (done, path) = (self.results.len(), self.path.display());
        Failure::Interrupted(format!(
            "stopped; {done} finished trials are in {path}, and the same command goes on"
        ))
    }

    /// Makes all tables from the journal, in a folder.
    pub(super) fn tables_in(&mut self, path: &Path, stop: &AtomicBool) -> Result<Vec<FileHash>, Failure> {
        let experiment = Arc::clone(&self.experiment);
        let mut tables = Tables::new(path, &experiment)?;
        for place in self.journal.places().collect::<Vec<_>>() {
            if stop.load(Ordering::Relaxed) {
                return Err(self.interrupted());
            }
            tables.add(&self.outcome(place)?, &experiment)?;
        }
        tables.finish()
    }

    /// Makes the tables, unless they are there already.
    ///
    /// # Errors
    /// The disk does not take them, or `stop` was set: the same command makes them.
    pub fn finish(&mut self, stop: &AtomicBool) -> Result<(), Failure> {
        if self.manifest.is_complete {
            return Ok(());
        }
        self.journal.tidy()?;
        let finished = self.tables_in(&self.path.clone(), stop)?;
        self.manifest.files.extend(finished);
        self.manifest.files.extend(write_dictionary(&self.path, &self.experiment)?);
        let journal = self.path.join(journal::FILE);
        let hash = file_hash(&journal)
            .map_err(|error| Failure::storage(format!("{}: {error}", journal.display())))?;
        self.manifest.files.push(FileHash { name: journal::FILE.into(), xxh3_128: hash });
        self.manifest.is_complete = true;
        write_manifest(&self.path, &self.manifest)
    }
}

fn again(damage: String) -> String {
    damage + "; what it held is run again"
}
