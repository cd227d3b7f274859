//! The exact results of `scenarios/paper.ron`. A change of any of them is a change of every published number: it must be meant, and
//! told in the changelog.

use rayon::prelude::*;

use usar_sim::record::Status;

use crate::support::{paper, trial};

/// Seed, policy, rescuees of the hard and of the easy task, complete rounds.
const EXPECTED: [(u64, &str, u32, u32, u32); 15] = [
    (1, "RNE", 113, 108, 6),
    (1, "DIS", 103, 107, 5),
    (1, "ENG", 105, 80, 6),
    (1, "HP_DIS", 103, 108, 5),
    (1, "RANDOM", 101, 120, 6),
    (2, "RNE", 120, 88, 6),
    (2, "DIS", 113, 114, 5),
    (2, "ENG", 120, 93, 6),
    (2, "HP_DIS", 114, 110, 5),
    (2, "RANDOM", 106, 104, 6),
    (3, "RNE", 120, 99, 6),
    (3, "DIS", 100, 111, 5),
    (3, "ENG", 120, 99, 6),
    (3, "HP_DIS", 113, 106, 6),
    (3, "RANDOM", 99, 102, 6),
];

#[test]
fn three_seeds_and_five_policies_rescue_exactly_as_many() {
    let scenario = paper();
    let found: Vec<_> = EXPECTED
        .par_iter()
        .map(|(seed, policy, ..)| {
            let record = trial(&scenario, policy, *seed);
            assert!(
                !matches!(record.status, Status::Failed(_)),
                "{policy}, seed {seed}: {:?}",
                record.status
            );
            let rescued = |task| record.task(task).unwrap().rescued;
            (*seed, *policy, rescued("hard"), rescued("easy"), record.completed_rounds)
        })
        .collect();
    assert_eq!(found, EXPECTED);
}
