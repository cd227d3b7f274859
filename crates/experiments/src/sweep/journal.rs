//! `journal.jsonl`: each trial is on disk as soon as it ends, as a line with its checksum. Everything else in
//! a sweep's folder is made from it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use store::lock::Lock;
use store::{Failure, Header, Line, Log};

use super::line::{Finished, LineError, finished_of};
use crate::experiment::{Experiment, Place, Shard, deciding_text};
use crate::run::FaultKind;

/// Name of the file.
pub const FILE: &str = "journal.jsonl";
/// Name of the journal of a finished sweep, its lines in order, compressed.
pub const ARCHIVE: &str = "journal.jsonl.gz";

/// The journal of a sweep's folder.
pub(super) struct Journal {
    log: Log,
    /// Offset and size of each finished trial's line.
    lines: BTreeMap<Place, (u64, usize)>,
    /// Trials of policies whose sources have changed since.
    former: BTreeSet<Place>,
}

/// The first line of a sweep's journal.
pub(super) fn header(experiment: &Experiment) -> Header {
    Header::new("sweep", &format!("bits {} {}", experiment.program.bits, deciding_text(&experiment.base)))
}

impl Journal {
    /// Opens the journal of a folder, for the whole sweep or one shard, and hands each finished trial to
    /// `found`, in the order of the file. With a lock, trials can be added, and trials that timed out count
    /// as not run.
    ///
    /// # Errors
    /// The file cannot be read, or is not of this sweep.
    pub(super) fn open(
        folder: &Path,
        experiment: &Experiment,
        shard: Option<Shard>,
        lock: Option<Arc<Lock>>,
        mut found: impl FnMut(Finished),
    ) -> Result<Self, Failure> {
        let (mut lines, mut former) = (BTreeMap::new(), BTreeSet::new());
        let (path, header, is_writable) = (folder.join(FILE), header(experiment), lock.is_some());
        let line = |line: &Line| {
            let finished = match finished_of(line.entry, experiment, shard) {
                Err(LineError::OtherProgram { place }) => {
                    former.insert(place);
                    return Ok(());
                }
                finished => finished?,
            };
            let timed_out = matches!(&finished.result, Err(fault) if fault.kind == FaultKind::TimedOut);
            if !(timed_out && is_writable) {
                lines.insert(finished.place(), (line.start, line.size));
                found(finished);
            }
            Ok(())
        };
        let log = match lock {
            Some(lock) => Log::open(&path, &header, lock, line),
            None => Log::view(&path, &header, line),
        }?;
        Ok(Self { log, lines, former })
    }

    /// For each policy whose sources have changed, the number of its trials that are to be run again.
    pub(super) fn outdated(&self) -> BTreeMap<usize, usize> {
        let mut outdated = BTreeMap::new();
        for (_, policy, _) in self.former.iter().filter(|place| !self.lines.contains_key(place)) {
            *outdated.entry(*policy).or_default() += 1;
        }
        outdated
    }

    /// Adds lines. They are on disk when this returns.
    ///
    /// # Errors
    /// The disk does not take them. The journal is then unchanged.
    pub(super) fn append(&mut self, added: &[(Place, Vec<u8>)]) -> Result<(), Failure> {
        let bytes: Vec<u8> = added.iter().flat_map(|(_, line)| line).copied().collect();
        let mut start = self.log.append(&bytes)?;
        for (place, line) in added {
            self.lines.insert(*place, (start, line.len()));
            start += line.len() as u64;
        }
        Ok(())
    }

    /// The line of a finished trial.
    ///
    /// # Errors
    /// The file cannot be read.
    pub(super) fn line(&mut self, place: Place) -> Result<Vec<u8>, Failure> {
        let no_such = || Failure::storage(format!("{FILE}: has no such trial"));
        let (start, size) = self.lines.get(&place).copied().ok_or_else(no_such)?;
        self.log.line(start, size)
    }
}
