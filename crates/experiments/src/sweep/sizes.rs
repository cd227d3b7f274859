//! The disk space that trials take, measured from a few of them.

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

use store::Failure;

use super::closing::Closing;
use super::line::line_of;
use crate::experiment::{Experiment, Keep, Place, Shard};
use crate::run::Outcome;

/// Bytes on disk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sizes {
    /// Of the finished folder: the tables and the archive of the journal.
    pub finished: u64,
    /// Of the journal, while the sweep runs.
    pub journal: u64,
}

/// The disk space that these trials of a sweep take, by themselves or as trials of a shard, if `keep` is
/// kept of each.
///
/// # Errors
/// There is no room for them in the folder of temporary files, or `stop` was set.
pub fn sizes(
    experiment: &Experiment,
    keep: Keep,
    shard: Option<Shard>,
    trials: &[Outcome],
    stop: &AtomicBool,
) -> Result<Sizes, Failure> {
    let place = tempfile::tempdir()?;
    let line = |outcome: &Outcome| {
        let key = &outcome.key;
        Ok(((key.case, key.policy, key.trial), line_of(experiment, keep, outcome)?))
    };
    let lines = trials.iter().map(line).collect::<Result<BTreeMap<Place, Vec<u8>>, Failure>>()?;
    let closing = Closing { folder: place.path(), experiment, keep, shard, stop };
    let made = closing.run(lines.keys().copied(), |place| Ok(lines[&place].clone()), |_, _| {})?;
    made.ok_or_else(|| Failure::Interrupted("stopped; nothing was written".to_owned()))?;
    let files = std::fs::read_dir(place.path())?.flatten().filter_map(|entry| entry.metadata().ok());
    let journal = lines.values().map(|line| line.len() as u64).sum();
    Ok(Sizes { finished: files.map(|file| file.len()).sum(), journal })
}
