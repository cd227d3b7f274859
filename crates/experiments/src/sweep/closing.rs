//! Closing a sweep: makes its tables and the archive of its journal from its trials, in one pass, on all
//! threads.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use store::Failure;
use store::archive::{MEMBER_BYTES, member};
use store::files::{FileHash, NewFile};

use super::journal::ARCHIVE;
use super::line::{Finished, finished_in};
use super::measured::Measured;
use super::tables::{TableRows, Tables};
use crate::experiment::{Experiment, Keep, Place, Shard};

/// Settings of the closing of a sweep.
pub(super) struct Closing<'a> {
    /// The folder to write to.
    pub folder: &'a Path,
    pub experiment: &'a Experiment,
    pub keep: Keep,
    pub shard: Option<Shard>,
    /// Interrupts the work.
    pub stop: &'a AtomicBool,
}

/// A batch of trials: their lines in order.
#[derive(Default)]
struct Batch {
    lines: Vec<u8>,
    places: Vec<(Place, usize)>,
}

/// The parts of files that a batch gives, and its results.
struct Made {
    rows: TableRows,
    member: Vec<u8>,
    results: Vec<(Place, Measured)>,
}

impl Closing<'_> {
    /// Makes the tables of these trials and the archive, and hands each trial's result to `found`. `None`
    /// if `stop` was set.
    ///
    /// # Errors
    /// A line cannot be read or belongs to another trial; the disk does not take a file.
    pub(super) fn run(
        &self,
        places: impl Iterator<Item = Place>,
        mut line: impl FnMut(Place) -> Result<Vec<u8>, Failure>,
        mut found: impl FnMut(Place, Measured),
    ) -> Result<Option<Vec<FileHash>>, Failure> {
        let mut tables = Tables::new(self.folder, self.experiment, self.keep, self.shard)?;
        let mut archive = NewFile::new(self.folder, ARCHIVE)?;
        let at_a_time = 2 * rayon::current_num_threads();
        let mut places = places.peekable();
        while places.peek().is_some() {
            if self.stop.load(Ordering::Relaxed) {
                return Ok(None);
            }
            let batches = (0..at_a_time).map(|_| Batch::next(&mut places, &mut line));
            let batches = batches.collect::<Result<Vec<_>, _>>()?;
            let count = tables.count();
            let made: Vec<_> = batches.par_iter().map(|batch| self.make(batch, count)).collect();
            for made in made {
                let Made { rows, member, results } = made?;
                tables.append(rows)?;
                archive.append(&member)?;
                results.into_iter().for_each(|(place, measured)| found(place, measured));
            }
        }
        let mut files = tables.finish()?;
        files.push(archive.finish()?);
        Ok(Some(files))
    }

    fn make(&self, batch: &Batch, tables: usize) -> Result<Made, Failure> {
        let finished = batch.finished(self.experiment)?;
        let rows = Tables::rows(tables, finished.iter(), self.experiment)?;
        let member = match batch.places.len() {
            0 => Vec::new(),
            count => member(&batch.lines, count)?,
        };
        let measure = |finished: &Finished| Measured::of_finished(finished, self.experiment);
        let results = finished.iter().map(|finished| (finished.place(), measure(finished))).collect();
        Ok(Made { rows, member, results })
    }
}

impl Batch {
    /// The next trials, enough to fill a member of the archive.
    fn next(
        places: &mut impl Iterator<Item = Place>,
        line: &mut impl FnMut(Place) -> Result<Vec<u8>, Failure>,
    ) -> Result<Self, Failure> {
        let mut batch = Self::default();
        while batch.lines.len() < MEMBER_BYTES {
            let Some(place) = places.next() else { break };
            batch.lines.extend(line(place)?);
            batch.places.push((place, batch.lines.len()));
        }
        Ok(batch)
    }

    fn finished(&self, experiment: &Experiment) -> Result<Vec<Finished>, Failure> {
        let mut start = 0;
        let one = |(place, end): &(Place, usize)| {
            let line = &self.lines[std::mem::replace(&mut start, *end)..*end];
            let finished = finished_in(line, experiment);
            let finished = finished.map_err(|reason| Failure::storage(format!("the journal: {reason}")))?;
            if finished.place() == *place {
                Ok(finished)
            } else {
                Err(Failure::storage("the journal: is not its trials in order"))
            }
        };
        self.places.iter().map(one).collect()
    }
}
