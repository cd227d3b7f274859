//! A sample of the random feasible worlds; all 500 are a recipe.

use rayon::prelude::*;
use usar_sim::scenario::Scenario;
use xtask::journeys::{Journeys, STANDSTILL_S};
use xtask::worlds::world;

#[test]
fn in_30_random_worlds_nobody_stands_still_for_good_and_no_invariant_is_violated() {
    let results: Vec<(u64, Journeys)> = (1000..1030_u64)
        .into_par_iter()
        .map(|seed| {
            let mut file = (*world(seed)).clone();
            file.duration_s = 100.0; // the recipe runs them to their end
            let scenario = Scenario::try_from(file).unwrap();
            let journeys =
                Journeys::run(&scenario, seed).unwrap_or_else(|reason| panic!("world {seed}: {reason}"));
            (seed, journeys)
        })
        .collect();
    for (seed, journeys) in results {
        let standstill = journeys.standstill_s;
        assert!(standstill <= STANDSTILL_S, "world {seed}: all stood for {standstill} s");
        for stall in journeys.stalls() {
            assert!(!stall.contains("nothing_to_do"), "world {seed}: {stall} has no cause");
        }
    }
}
