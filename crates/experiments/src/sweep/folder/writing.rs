//! Adding trials to a folder, and closing it when all trials are finished.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use store::files::{self, FileHash};
use store::{Failure, at};

use super::Folder;
use crate::experiment::{Experiment, Place};
use crate::run::Outcome;
use crate::sweep::closing::Closing;
use crate::sweep::disk::{write_manifest, write_start};
use crate::sweep::journal::{self, Journal};
use crate::sweep::line::line_of;
use crate::sweep::measured::Measured;
use crate::sweep::store::{Order, Store, thaw};

impl Folder {
    /// Continues with more trials of the same sweep.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn extend(&mut self, experiment: Arc<Experiment>) -> Result<(), Failure> {
        self.manifest = write_start(&self.path, &experiment, self.manifest.shard)?;
        if !matches!(self.store, Store::Journal(_)) {
            thaw(&self.path, &experiment)?;
            let shard = self.manifest.shard;
            let journal = Journal::open(&self.path, &experiment, shard, self.lock.clone(), |_| {})?;
            self.store = Store::Journal(journal);
        }
        self.experiment = experiment;
        Ok(())
    }

    /// Adds trials. They are on disk when this returns.
    ///
    /// # Errors
    /// The disk does not take them.
    pub fn add(&mut self, outcomes: &[Outcome]) -> Result<(), Failure> {
        let Store::Journal(journal) = &mut self.store else {
            return Err(Failure::run("a finished sweep takes no trials"));
        };
        let place = |outcome: &Outcome| (outcome.key.case, outcome.key.policy, outcome.key.trial);
        let line = |outcome| Ok((place(outcome), line_of(&self.experiment, self.experiment.keep, outcome)?));
        journal.append(&outcomes.iter().map(line).collect::<Result<Vec<_>, Failure>>()?)?;
        let measured = |outcome| (place(outcome), Measured::of(outcome, &self.experiment.metrics));
        self.results.extend(outcomes.iter().map(measured));
        Ok(())
    }

    /// Makes all tables and the archive from the store, in another folder; `None` if `stop` was set.
    pub(in crate::sweep) fn tables_in(
        &mut self,
        folder: &Path,
        stop: &AtomicBool,
    ) -> Result<Option<Vec<FileHash>>, Failure> {
        let Self { experiment, store, results, manifest, .. } = self;
        let closing = Closing { folder, experiment, keep: experiment.keep, shard: manifest.shard, stop };
        closing.run(results.keys().copied(), |place| store.line(place), |_, _| {})
    }

    /// Makes the tables, unless the folder is complete.
    ///
    /// # Errors
    /// The disk does not take them, or `stop` was set. The same command resumes.
    pub fn finish(&mut self, stop: &AtomicBool) -> Result<(), Failure> {
        if self.manifest.is_complete {
            return Ok(());
        }
        let path = self.path.clone();
        let made = self.tables_in(&path, stop)?.ok_or_else(|| self.interrupted())?;
        self.close(made)
    }

    /// Takes all trials from another source, in order, and makes the tables.
    ///
    /// # Errors
    /// A line cannot be read, the disk does not take it, or `stop` was set.
    pub(in crate::sweep) fn fill(
        &mut self,
        line: impl FnMut(Place) -> Result<Vec<u8>, Failure>,
        stop: &AtomicBool,
    ) -> Result<(), Failure> {
        let (path, experiment) = (self.path.clone(), Arc::clone(&self.experiment));
        let keep = experiment.keep;
        let closing = Closing { folder: &path, experiment: &experiment, keep, shard: None, stop };
        let results = &mut self.results;
        let found = |place, measured| {
            results.insert(place, measured);
        };
        let made = closing.run(experiment.places(None), line, found)?;
        self.close(made.ok_or_else(|| self.interrupted())?)
    }

    fn close(&mut self, made: Vec<FileHash>) -> Result<(), Failure> {
        self.manifest.files.extend(made);
        self.manifest.is_complete = true;
        write_manifest(&self.path, &self.manifest)?;
        let order = Order::of(&self.experiment, self.manifest.shard);
        self.store = Store::archive(&self.path, order).map_err(Failure::storage)?;
        let journal = self.path.join(journal::FILE);
        files::remove(&journal).map_err(at(&journal))
    }
}
