//! Storage of a folder's trials: in the journal while trials may be added, in the archive when all are
//! finished.

use std::io;
use std::path::Path;

use store::archive::Archive;
use store::files::{self, NewFile};
use store::{Failure, at};

use super::journal::{self, ARCHIVE, Journal};
use super::line::{Finished, LineError, finished_in};
use crate::experiment::{Experiment, Place, Shard};

/// The trials of a folder.
pub(super) enum Store {
    /// The journal; trials may be added.
    Journal(Journal),
    /// The archive with all trials, in order.
    Archive(Archive, Order),
}

impl Store {
    /// The line of a trial.
    ///
    /// # Errors
    /// The trial is not in the store, or cannot be read.
    pub(super) fn line(&mut self, place: Place) -> Result<Vec<u8>, Failure> {
        let (archive, number) = match self {
            Self::Journal(journal) => return journal.line(place),
            Self::Archive(archive, order) => (archive, order.rank(place)),
        };
        let no_such = || io::Error::new(io::ErrorKind::NotFound, "it has no such trial");
        let line = number.ok_or_else(no_such).and_then(|number| archive.line(number).map(<[u8]>::to_vec));
        line.map_err(|error| Failure::storage(format!("{ARCHIVE}: {error}")))
    }

    /// A finished trial of the folder with this path.
    ///
    /// # Errors
    /// Those of [`Store::line`], or the trial was changed since it was written.
    pub(super) fn finished(
        &mut self,
        place: Place,
        experiment: &Experiment,
        folder: &Path,
    ) -> Result<Finished, Failure> {
        let line = self.line(place)?;
        let in_its_place = |finished: Finished| match finished.place() {
            found if found == place => Ok(finished),
            _ => Err(LineError::OtherPlace),
        };
        finished_in(&line, experiment)
            .and_then(in_its_place)
            .map_err(|reason| Failure::input(format!("{}: {reason}", folder.join(self.name()).display())))
    }

    /// Name of the file with the trials.
    pub(super) fn name(&self) -> &'static str {
        if let Self::Journal(_) = self { journal::FILE } else { ARCHIVE }
    }

    /// The archive of a folder that has all trials.
    ///
    /// # Errors
    /// The archive cannot be read, or has another number of lines.
    pub(super) fn archive(folder: &Path, order: Order) -> io::Result<Self> {
        let archive = Archive::open(&folder.join(ARCHIVE))?;
        if archive.count() != order.count() {
            let reason = format!("has {} trials of {}", archive.count(), order.count());
            return Err(io::Error::new(io::ErrorKind::InvalidData, reason));
        }
        Ok(Self::Archive(archive, order))
    }
}

/// Restores the journal of a folder from its archive if there is no journal, so that trials can be added.
/// Unreadable and changed lines of the archive are not in the journal.
///
/// # Errors
/// The disk does not take it.
pub(super) fn thaw(folder: &Path, experiment: &Experiment) -> Result<(), Failure> {
    let [journal, pressed] = [journal::FILE, ARCHIVE].map(|name| folder.join(name));
    files::check_is_file(&pressed).map_err(at(&pressed))?;
    if journal.symlink_metadata().is_err() && pressed.exists() {
        let mut file = NewFile::new(folder, journal::FILE)?;
        file.append(&journal::header(experiment).line())?;
        for lines in Archive::salvage(&pressed).map_err(at(&pressed))? {
            let lines = lines.split_inclusive(|byte| *byte == b'\n');
            lines.filter(|line| store::entry_of(line).is_some()).try_for_each(|line| file.append(line))?;
        }
        file.finish()?;
        files::sync_folder(folder)?;
    }
    files::remove(&pressed).map_err(at(&pressed))
}

/// The order of a folder's trials, computed without a list of them.
pub(super) struct Order {
    policies: usize,
    /// For each case, the number of trials in earlier cases, and the numbers of its own trials.
    cases: Vec<(usize, Vec<u32>)>,
    count: usize,
}

impl Order {
    /// The order of a sweep or a shard of it.
    pub(super) fn of(experiment: &Experiment, shard: Option<Shard>) -> Self {
        let policies = experiment.policies.len();
        let (mut cases, mut count) = (Vec::new(), 0);
        for case in 0..experiment.cases.len() {
            let trials: Vec<u32> = experiment.trials_of(case, shard).collect();
            let of_case = trials.len() * policies;
            cases.push((count, trials));
            count += of_case;
        }
        Self { policies, cases, count }
    }

    /// Number of trials.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The number of a trial's line, from 0.
    pub(super) fn rank(&self, place: Place) -> Option<usize> {
        let (case, policy, trial) = place;
        let (before, trials) = self.cases.get(case).filter(|_| policy < self.policies)?;
        let place = trials.binary_search(&trial).ok()?;
        Some(before + policy * trials.len() + place)
    }
}
