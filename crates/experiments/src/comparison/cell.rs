//! A cell of a sweep.

use crate::sweep::folder::Folder;

/// A cell of a sweep: the places of a case and of a policy.
pub type Cell = (usize, usize);

/// The hashes of the last states of trials of the same number; 0 for one without numbers, or that has not
/// been run.
pub(super) fn hashes(folder: &Folder, cells: &[Cell], trial: u32) -> Vec<u128> {
    let hash = |(case, policy): &Cell| {
        folder.results().get(&(*case, *policy, trial)).map_or(0, |measured| measured.hash)
    };
    cells.iter().map(hash).collect()
}
