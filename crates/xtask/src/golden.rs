//! The hashes of the small worlds: computed, and expected.

use std::fmt::Write;
use std::path::PathBuf;

use scenario::Scenario;
use usar_sim::simulation::Simulation;

use crate::docs::place;

/// Path of the file with the expected hashes.
pub fn path() -> PathBuf {
    place("tests/golden_hashes.txt")
}

/// A line for each small world and policy, with the hash of the state at the end of the trial with seed 1.
pub fn hashes() -> String {
    let mut files: Vec<PathBuf> = std::fs::read_dir(place("scenarios/minimal"))
        .expect("there are small worlds")
        .map(|entry| entry.expect("readable").path())
        .collect();
    files.sort();
    let mut rne = policies::standard().open("RNE").expect("known");
    let mut text = String::new();
    for path in files {
        let (scenario, _) = Scenario::load(&path).unwrap_or_else(|error| panic!("{error}"));
        let trial = Simulation::new(&scenario, 1).expect("drawn");
        let record = trial.run(&mut *rne, |_, _, _| {});
        writeln!(text, "{} {}", scenario.name, record.state_hash).expect("memory");
    }
    text
}
