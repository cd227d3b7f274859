//! What several tests need.

use std::path::{Path, PathBuf};

use scenario::Scenario;
use scenario::shapes::Outline;
use teaming::Session;
use usar_sim::ids::RobotId;
use usar_sim::record::TrialRecord;
use usar_sim::report::{Report, Speaker, Statement};
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

/// What makes the tasks of paper.ron ask for sampled debris and radiation: texts and what takes their place.
pub const SAMPLED: [(&str, &str); 2] = [
    ("rest: (27.0, 14.5)", "rest: (27.0, 14.5), sampled: (debris: 10, radiation: 4)"),
    ("rest: (66.0, 14.5)", "rest: (66.0, 14.5), sampled: (debris: 4, radiation: 1)"),
];

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

/// A session of the policy of that name, with options where they are given: `RNE(score: Sum)`.
pub fn policy(text: &str) -> Box<dyn Session> {
    policies::standard().open(text).unwrap_or_else(|error| panic!("{error}"))
}

/// One trial, with every invariant checked at every step.
pub fn trial(scenario: &Scenario, name: &str, seed: u64) -> TrialRecord {
    Simulation::new(scenario, seed).unwrap().checked().run(&mut *policy(name), |_, _, _| {})
}

/// Robot 0's report that a piece of debris lies here.
pub fn lies(piece: usize, outline: &Outline, at_step: u64) -> Report {
    let (shape, pose) = (outline.shape.clone(), outline.pose);
    let says = Statement::DebrisLies { debris: piece as u32, shape, pose };
    Report { from: Speaker::Robot(RobotId(0)), says, at_step, sd_m: 0.0 }
}

/// The Rust files below a folder with their texts, without what was built.
pub fn rust_files(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.ends_with("target") {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|kind| kind == "rs") {
            files.push((path.clone(), std::fs::read_to_string(path).unwrap()));
        }
    }
    files.sort();
    files
}
