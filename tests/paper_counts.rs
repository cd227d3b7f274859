//! The exact results of `scenarios/paper.ron`. A change of any of them is a change of every published number: it must be meant, and
//! told in the changelog.

use rayon::prelude::*;

use crate::support::{paper, trial};

/// Seed, policy, rescuees of the hard and of the easy task, complete rounds.
const EXPECTED: [(u64, &str, u32, u32, u32); 15] = [
    (1, "RNE", 0, 0, 0),
    (1, "DIS", 0, 0, 0),
    (1, "ENG", 0, 0, 0),
    (1, "HP_DIS", 0, 0, 0),
    (1, "RANDOM", 0, 0, 0),
    (2, "RNE", 0, 0, 0),
    (2, "DIS", 0, 0, 0),
    (2, "ENG", 0, 0, 0),
    (2, "HP_DIS", 0, 0, 0),
    (2, "RANDOM", 0, 0, 0),
    (3, "RNE", 0, 0, 0),
    (3, "DIS", 0, 0, 0),
    (3, "ENG", 0, 0, 0),
    (3, "HP_DIS", 0, 0, 0),
    (3, "RANDOM", 0, 0, 0),
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
