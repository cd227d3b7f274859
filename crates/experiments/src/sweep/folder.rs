//! The folder of a sweep's results: it can be resumed at any moment, and has the same bytes in the end.
//!
//! `journal.jsonl` receives each trial as it ends. When all trials are finished, the tables are made from
//! the journal, and its lines go in order into `journal.jsonl.gz`. The manifest defines the sweep from the
//! first moment on. The same command therefore resumes it, and a different sweep is refused.

#[cfg(test)]
mod tests;
mod writing;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use teaming::Registry;

use store::{Failure, at};

use store::files::{self, check_is_file};
use store::lock::Lock;
use store::owned::check_is_owned;

use super::disk::{
    broken_files, check_continues, experiment_of, has_begun, manifest_in, read_manifest, write_start,
};
use super::journal::{self, ARCHIVE, Journal};
use super::line::{Finished, Kept};
use super::measured::read_results;
use super::names::is_sweeps;
use super::owned::{check_may_be_cleared, clear, remove_unfinished};
use super::store::{Order, Store, thaw};
use super::tables::TRIALS;
use crate::experiment::{Experiment, Place, Shard};
use crate::job::interrupted;
use crate::provenance::Manifest;
use crate::run::{Outcome, TrialKey};

pub use super::measured::{Measured, Results};

/// A sweep's folder and its finished trials.
pub struct Folder {
    path: PathBuf,
    experiment: Arc<Experiment>,
    manifest: Manifest,
    store: Store,
    results: Results,
    /// Held until the folder is dropped.
    lock: Option<Arc<Lock>>,
}

/// How to open a folder for writing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Opening {
    /// The part of the sweep to run.
    pub shard: Option<Shard>,
    /// Start over: delete an existing sweep.
    pub is_fresh: bool,
    /// Take no lock: the user knows that no other process writes there.
    pub has_no_lock: bool,
}

impl Folder {
    /// Opens the folder of a new sweep, or of a sweep to resume or extend. Messages go to `say`.
    ///
    /// # Errors
    /// The folder belongs to something else or cannot be used, or another process uses it.
    pub fn open(
        path: &Path,
        experiment: Arc<Experiment>,
        opening: Opening,
        say: &mut dyn FnMut(String),
    ) -> Result<Self, Failure> {
        check_is_owned(path, "sweep", is_sweeps(path))?;
        let trouble = |error| Failure::storage(format!("cannot write to {}: {error}", path.display()));
        fs::create_dir_all(path).map_err(trouble)?;
        path.parent().map_or(Ok(()), files::sync_folder)?;
        let lock = if opening.has_no_lock { Lock::none() } else { Lock::of_folder(path)? };
        let lock = Some(Arc::new(lock));
        if opening.is_fresh {
            check_may_be_cleared(path)?;
            clear(path).map_err(trouble)?;
        }
        remove_unfinished(path).map_err(trouble)?;
        let manifest = Manifest::new(&experiment, opening.shard, Vec::new());
        for name in [journal::FILE, ARCHIVE] {
            let file = path.join(name);
            check_is_file(&file).map_err(at(&file))?;
        }
        if let Some(done) = Self::is_done(path, &manifest, &experiment, say)?
            && let Ok((store, results)) = Self::closed(path, &experiment, opening.shard)
            && !results.values().any(Measured::is_late)
        {
            files::remove(&path.join(journal::FILE)).map_err(trouble)?;
            let path = path.to_owned();
            return Ok(Self { path, experiment, manifest: done, store, results, lock });
        }
        // The manifest and the inputs are on disk before the journal.
        let manifest = write_start(path, &experiment, opening.shard)?;
        thaw(path, &experiment)?;
        let (folder, outdated) = Self::with_journal(path, experiment, manifest, lock)?;
        for (policy, trials) in outdated {
            let (path, policy) = (path.display(), &folder.experiment.policies[policy].label);
            say(format!("{path}: policy {policy} has changed since; its trials are run again: {trials}"));
        }
        Ok(folder)
    }

    /// The manifest of a folder that holds this very sweep, finished and sound.
    fn is_done(
        path: &Path,
        manifest: &Manifest,
        experiment: &Experiment,
        say: &mut dyn FnMut(String),
    ) -> Result<Option<Manifest>, Failure> {
        if !has_begun(path) {
            return Ok(None);
        }
        let Some(there) = read_manifest(path)? else { return Ok(None) };
        check_continues(path, &there, manifest, &experiment.base.resolved())?;
        let broken = broken_files(path, &there);
        for name in &broken {
            let name = path.join(name);
            say(format!("{}: does not have the checksum of the manifest; it is made again", name.display()));
        }
        let is_same = there.is_complete && there.started() == *manifest;
        Ok((is_same && broken.is_empty()).then_some(there))
    }

    /// The trials and results of a sweep or shard that is finished and sound.
    fn closed(
        path: &Path,
        experiment: &Experiment,
        shard: Option<Shard>,
    ) -> Result<(Store, Results), Failure> {
        let store = Store::archive(path, Order::of(experiment, shard))
            .map_err(Failure::input_at(path.join(ARCHIVE).display()))?;
        let table = path.join(TRIALS);
        let results = read_results(&table, experiment, shard).map_err(Failure::input_at(table.display()))?;
        Ok((store, results))
    }

    /// Reads a folder, complete or not, with policies of a registry.
    ///
    /// # Errors
    /// It is not the folder of a sweep, or its files are damaged.
    pub fn read(path: &Path, registry: &Registry) -> Result<Self, Failure> {
        match Self::read_damaged(path, registry)? {
            (folder, None) => Ok(folder),
            (_, Some(damage)) => Err(Failure::input(damage)),
        }
    }

    /// Reads a folder whose trials are sound, and returns the damage of its other files.
    ///
    /// # Errors
    /// The folder does not hold a sweep, or its trials are damaged.
    pub fn read_damaged(path: &Path, registry: &Registry) -> Result<(Self, Option<String>), Failure> {
        let manifest = manifest_in(path)?;
        let experiment = Arc::new(experiment_of(path, &manifest, registry)?);
        let broken = broken_files(path, &manifest);
        let damage = || {
            format!(
                "{}: these files do not have the checksums of the manifest: {}; the sweep's command makes \
                 them again",
                path.display(),
                broken.join(", ")
            )
        };
        if broken.iter().any(|name| [ARCHIVE, TRIALS].contains(&name.as_str())) {
            return Err(Failure::input(damage()));
        }
        let folder = if manifest.files.iter().any(|file| file.name == ARCHIVE) {
            let (store, results) = Self::closed(path, &experiment, manifest.shard)?;
            Self { path: path.to_owned(), experiment, manifest, store, results, lock: None }
        } else {
            Self::with_journal(path, experiment, manifest, None)?.0
        };
        Ok((folder, (!broken.is_empty()).then(damage)))
    }

    /// The store and the places of the trials; the results are dropped.
    pub(super) fn into_store(self) -> (Store, Vec<Place>) {
        (self.store, self.results.into_keys().collect())
    }

    /// A folder with its journal; with a lock, trials can be added. Returns also the numbers of trials that
    /// are outdated, by policy.
    fn with_journal(
        path: &Path,
        experiment: Arc<Experiment>,
        manifest: Manifest,
        lock: Option<Arc<Lock>>,
    ) -> Result<(Self, BTreeMap<usize, usize>), Failure> {
        let mut results = Results::new();
        let journal = Journal::open(path, &experiment, manifest.shard, lock.clone(), |finished| {
            results.insert(finished.place(), Measured::of_finished(&finished, &experiment));
        })?;
        let outdated = journal.outdated();
        let (path, store) = (path.to_owned(), Store::Journal(journal));
        Ok((Self { path, experiment, manifest, store, results, lock }, outdated))
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The experiment of the folder.
    pub fn experiment(&self) -> &Experiment {
        &self.experiment
    }

    /// The experiment, to share with threads.
    pub fn shared_experiment(&self) -> Arc<Experiment> {
        Arc::clone(&self.experiment)
    }

    /// The manifest.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// The results of the finished trials, by place.
    pub fn results(&self) -> &Results {
        &self.results
    }

    /// The finished trials of one case and policy, in their order.
    pub fn places(&self, case: usize, policy: usize) -> Vec<Place> {
        self.results.range((case, policy, 0)..=(case, policy, u32::MAX)).map(|(place, _)| *place).collect()
    }

    /// The value of a metric in one trial; `None` if the trial has no value, failed, or has not been run.
    pub fn value(&self, place: Place, metric: usize) -> Option<f64> {
        self.results.get(&place)?.metrics.as_ref()?.get(metric)
    }

    /// The values of a metric for one case and policy, from the trials that ran to their end and have a
    /// value.
    pub fn values(&self, case: usize, policy: usize, metric: usize) -> Vec<f64> {
        let trials = self.results.range((case, policy, 0)..=(case, policy, u32::MAX));
        let measured = trials.filter_map(|(_, Measured { metrics, .. })| metrics.as_ref());
        measured.filter_map(|metrics| metrics.get(metric)).collect()
    }

    /// Number of trials that the folder is to have for a case and each policy: of its shard, or of the
    /// whole sweep.
    pub fn trials_of(&self, case: usize) -> usize {
        self.experiment.trials_of(case, self.manifest.shard).count()
    }

    /// Whether a trial is finished.
    pub fn has(&self, key: &TrialKey) -> bool {
        self.results.contains_key(&(key.case, key.policy, key.trial))
    }

    /// A finished trial.
    ///
    /// # Errors
    /// The journal cannot be read, or the sweep keeps only the metrics of a trial.
    pub fn outcome(&mut self, place: Place) -> Result<Outcome, Failure> {
        let Finished { key, result } = self.finished(place)?;
        let result = match result {
            Ok(Kept::Record(trial)) => Ok(*trial),
            Err(fault) => Err(fault),
            Ok(Kept::Summary(_)) => {
                return Err(Failure::input(format!(
                    "{}: keeps the metrics of its trials only, not their rounds and decisions; \
                     a sweep with `--keep rounds` has them",
                    self.path.display()
                )));
            }
        };
        Ok(Outcome { key, result })
    }

    /// The hash of a trial's last state, if it ran to its end.
    ///
    /// # Errors
    /// The journal cannot be read.
    pub fn state_hash(&mut self, place: Place) -> Result<Option<String>, Failure> {
        let finished = self.finished(place)?;
        Ok(finished.summary(&self.experiment).ok().map(|summary| summary.state_hash))
    }

    pub(super) fn finished(&mut self, place: Place) -> Result<Finished, Failure> {
        self.store.finished(place, &self.experiment, &self.path)
    }

    /// The line of a trial in the journal.
    ///
    /// # Errors
    /// The journal cannot be read.
    pub(super) fn line(&mut self, place: Place) -> Result<Vec<u8>, Failure> {
        self.store.line(place)
    }

    /// The message after an interruption.
    pub fn interrupted(&self) -> Failure {
        interrupted(&self.path, format!("{} finished trials are", self.results.len()))
    }
}
