//! What several tests need.

use std::path::{Path, PathBuf};

use rne_core::policy_named;
use usar_sim::record::TrialRecord;
use usar_sim::scenario::Scenario;
use usar_sim::simulation::Simulation;

/// The root of the workspace.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

/// The text of `scenarios/paper.ron`.
pub fn paper_text() -> String {
    std::fs::read_to_string(root().join("scenarios/paper.ron")).unwrap()
}

/// `scenarios/paper.ron`.
pub fn paper() -> Scenario {
    Scenario::parse(&paper_text(), "paper.ron".as_ref()).unwrap_or_else(|error| panic!("{error}"))
}

/// `scenarios/paper.ron` with this text replaced by that; the text must be there.
#[track_caller]
pub fn paper_with(replacements: &[(&str, &str)]) -> Scenario {
    let mut text = paper_text();
    for (from, to) in replacements {
        assert!(text.contains(from), "{from:?} is not in paper.ron");
        text = text.replace(from, to);
    }
    Scenario::parse(&text, "paper.ron".as_ref()).unwrap_or_else(|error| panic!("{error}"))
}

/// One trial, with every invariant checked at every step.
pub fn trial(scenario: &Scenario, policy: &str, seed: u64) -> TrialRecord {
    let policy = policy_named(policy, &scenario.rne).unwrap();
    Simulation::new(scenario, &*policy, seed).unwrap().checked().run(|_, _, _| {})
}
