//! The exact results of `scenarios/paper.ron`. A change of any of them is a change of every published number:
//! it must be meant, and told in the changelog.

use rayon::prelude::*;

use usar_sim::record::Status;

use crate::support::{paper, trial};

/// Seed, policy, rescuees of the hard and of the easy task, complete rounds.
const EXPECTED: [(u64, &str, u32, u32, u32); 15] = [
    (1, "RNE", 114, 106, 6),
    (1, "DIS", 103, 107, 6),
    (1, "ENG", 124, 98, 7),
    (1, "HP_DIS", 101, 109, 5),
    (1, "RANDOM", 101, 114, 6),
    (2, "RNE", 120, 89, 6),
    (2, "DIS", 102, 114, 5),
    (2, "ENG", 120, 94, 6),
    (2, "HP_DIS", 120, 110, 6),
    (2, "RANDOM", 113, 104, 5),
    (3, "RNE", 120, 99, 6),
    (3, "DIS", 105, 111, 5),
    (3, "ENG", 120, 99, 6),
    (3, "HP_DIS", 107, 101, 6),
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
