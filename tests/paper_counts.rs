//! The exact results of `scenarios/paper.ron`. A change of any of them is a change of every published number:
//! it must be meant, and told in the changelog.

use rayon::prelude::*;

use usar_sim::record::Status;

use crate::support::{paper, trial};

/// Seed, policy, rescuees of the hard and of the easy task, complete rounds.
const EXPECTED: [(u64, &str, u32, u32, u32); 15] = [
    (1, "RNE", 113, 93, 6),
    (1, "DIS", 101, 106, 6),
    (1, "ENG", 133, 98, 6),
    (1, "HP_DIS", 103, 108, 5),
    (1, "RANDOM", 101, 114, 5),
    (2, "RNE", 120, 83, 6),
    (2, "DIS", 107, 101, 6),
    (2, "ENG", 120, 96, 6),
    (2, "HP_DIS", 114, 114, 6),
    (2, "RANDOM", 112, 104, 5),
    (3, "RNE", 120, 99, 6),
    (3, "DIS", 105, 112, 5),
    (3, "ENG", 120, 99, 6),
    (3, "HP_DIS", 105, 107, 6),
    (3, "RANDOM", 101, 101, 6),
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
