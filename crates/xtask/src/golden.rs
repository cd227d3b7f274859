//! The hashes of the small worlds: computed, and expected.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use usar_sim::scenario::Scenario;
use usar_sim::simulation::Simulation;

fn root() -> &'static Path {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    manifest.ancestors().find(|folder| folder.join("scenarios").is_dir()).expect("inside the workspace")
}

/// Path of the file with the expected hashes.
pub fn path() -> PathBuf {
    root().join("tests/golden_hashes.txt")
}

/// A line for each small world and policy, with the hash of the state at the end of the trial with seed 1.
pub fn hashes() -> String {
    let mut files: Vec<PathBuf> = std::fs::read_dir(root().join("scenarios/minimal"))
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
