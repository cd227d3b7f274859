//! The exact results of `scenarios/paper.ron`. A change of any of them is a change of every published number: it must be meant, and
//! told in the changelog.

use rayon::prelude::*;

use crate::support::{paper, trial};

/// Seed, policy, rescuees of the hard and of the easy task, complete rounds.
const EXPECTED: [(u64, &str, u32, u32, u32); 15] = [
    (1, "RNE", 113, 107, 6),
    (1, "DIS", 103, 104, 5),
    (1, "ENG", 133, 103, 6),
    (1, "HP_DIS", 113, 107, 5),
    (1, "RANDOM", 101, 114, 5),
    (2, "RNE", 120, 84, 6),
    (2, "DIS", 107, 114, 5),
    (2, "ENG", 120, 90, 6),
    (2, "HP_DIS", 120, 108, 6),
    (2, "RANDOM", 113, 104, 5),
    (3, "RNE", 120, 99, 6),
    (3, "DIS", 94, 106, 5),
    (3, "ENG", 120, 99, 6),
    (3, "HP_DIS", 107, 107, 6),
    (3, "RANDOM", 106, 107, 5),
];

#[test]
fn three_seeds_and_five_policies_rescue_exactly_as_many() {
    let scenario = paper();
    let found: Vec<_> = EXPECTED
        .par_iter()
        .map(|(seed, policy, ..)| {
            let record = trial(&scenario, policy, *seed);
            (*seed, *policy, record.hard.rescued, record.easy.rescued, record.completed_rounds)
        })
        .collect();
    assert_eq!(found, EXPECTED);
}
