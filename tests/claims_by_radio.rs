//! Claims on rescuees that robots tell their mates by radio.

use rayon::prelude::*;
use usar_sim::event::Event;

use crate::robots_decide::{run, world};

const WORLDS: [&str; 6] = [
    "paper.ron",
    "three-tasks.ron",
    "crowded.ron",
    "trust/tunnel.ron",
    "trust/convoy.ron",
    "trust/aftershocks.ron",
];

/// Where all is heard at once, robots claim what their group would share out among them.
#[test]
fn claims_that_all_hear_at_once_are_those_of_the_group() {
    WORLDS.par_iter().for_each(|name| {
        let settings =
            |claims: &'static str| ["duration_s=300", "mission.belief_sharing=ByRadio", "medium=()", claims];
        for seed in 1..4 {
            let (known, happened) = run(&world(name, &settings("mission.claims=Known")), "RANDOM", seed);
            let (told, too) = run(&world(name, &settings("mission.claims=ByRadio()")), "RANDOM", seed);
            assert!(known.tasks.iter().any(|task| task.totals.rescued > 0), "{name}: nobody was rescued");
            let first = happened.iter().zip(&too).find(|(a, b)| a != b);
            assert!(happened == too, "{name}, seed {seed}: first other event {first:?}");
            assert_eq!(known.time_s.to_bits(), told.time_s.to_bits(), "{name}");
        }
    });
}

/// Where messages are lost, two robots go for one rescuee; the world lets only one of them load it.
#[test]
fn who_does_not_hear_of_a_claim_goes_on() {
    let walks = |loss: &str| {
        let medium = format!("medium=(loss: GilbertElliott(p: 0.5, r: 0.5, good: {loss}, bad: {loss}))");
        let settings =
            ["duration_s=300", "mission.belief_sharing=ByRadio", &medium, "mission.claims=ByRadio()"];
        let (record, events) = run(&world("three-tasks.ron", &settings), "RANDOM", 1);
        let mut loaded: Vec<_> = events
            .iter()
            .filter_map(|event| if let Event::Loaded { rescuee, .. } = event { Some(*rescuee) } else { None })
            .collect();
        let count = loaded.len();
        loaded.sort_unstable();
        loaded.dedup();
        assert_eq!(loaded.len(), count, "nobody is loaded twice");
        let metres = record.robots.iter().map(|robot| robot.distance_m).sum::<f64>();
        (count, metres / count as f64)
    };
    let [(all, near), (some, far)] = [walks("0.0"), walks("0.9")];
    assert!(some <= all && far > near, "{all} rescuees at {near:.1} m each, {some} at {far:.1} m");
}
