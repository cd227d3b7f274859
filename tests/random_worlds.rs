//! A sample of the random worlds; hundreds more are recipes.

use rayon::prelude::*;
use scenario::{Scenario, ScenarioFile};
use xtask::journeys::{Journeys, STANDSTILL_S};
use xtask::quiet::both_ways;
use xtask::worlds::world;
use xtask::{random, rooms};

#[test]
fn in_30_random_worlds_nobody_stands_still_for_good_and_no_invariant_is_violated() {
    let results: Vec<(u64, Journeys)> = (1000..1030_u64)
        .into_par_iter()
        .map(|seed| {
            let mut file = (*world(seed)).clone();
            file.duration_s = 100.0; // the recipe runs them to their end
            let scenario = Scenario::try_from(file).unwrap();
            let journeys = Journeys::run(&scenario, "RANDOM", seed)
                .unwrap_or_else(|reason| panic!("world {seed}: {reason}"));
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

#[test]
fn trials_are_the_same_with_the_engine_at_rest_in_quiet_steps_and_always_on() {
    let kinds: [fn(u64) -> Scenario; 3] = [world, rooms::rooms, random::scenario];
    let trials: Vec<_> = (0..24_u64).map(|seed| (seed, kinds[seed as usize % 3])).collect();
    let run = |(seed, world): &(u64, fn(u64) -> Scenario)| {
        let mut file = (*world(*seed)).clone();
        file.duration_s = 40.0;
        both_ways(&Scenario::try_from(file).unwrap(), *seed)
    };
    let ran: Vec<_> = trials.par_iter().filter_map(run).collect();
    let differing = ran.iter().filter(|both| both.differs_at.is_some()).count();
    let [all, on] = ran.iter().fold([0, 0], |[all, on], both| [all + both.steps[0], on + both.steps[1]]);
    assert_eq!((ran.len(), differing), (24, 0));
    assert!(0 < on && on < all / 2, "the engine ran in {on} of {all} steps");
}

/// In this world, two borders of velocities that are nearly parallel once led to more than the top speed.
#[test]
fn no_robot_is_faster_than_its_top_speed() {
    let file = ScenarioFile { duration_s: 630.0, ..(*rooms::rooms(521)).clone() };
    let journeys = Journeys::run(&Scenario::try_from(file).unwrap(), "RANDOM", 521);
    assert!(journeys.is_ok(), "{}", journeys.err().unwrap());
}
