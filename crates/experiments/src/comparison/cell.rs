//! A cell of a sweep.

use crate::sweep::folder::Folder;

/// A cell of a sweep: the places of a case and of a policy.
pub type Cell = (usize, usize);

/// What trials of the same number have in common if one repeats another: their last states. A trial without
/// numbers, or one that has not been run, repeats no other.
pub(super) fn same(folder: &Folder, cells: &[Cell], trial: u32) -> Vec<(u32, u128)> {
    let hash = |(case, policy): &Cell| {
        folder.results().get(&(*case, *policy, trial)).map_or(0, |measured| measured.hash)
    };
    let hashes: Vec<u128> = cells.iter().map(hash).collect();
    let own = if hashes.contains(&0) { trial } else { 0 };
    hashes.into_iter().map(|hash| (own, hash)).collect()
}
