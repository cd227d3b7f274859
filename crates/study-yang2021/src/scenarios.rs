//! What the paper's experiment runs: its policies, and the scenarios that stand for its world.

use std::path::Path;

use experiments::Failure;
use experiments::experiment::{Experiment, Overrides};

/// Policies of the paper.
pub const POLICIES: [&str; 4] = ["RNE", "DIS", "ENG", "HP_DIS"];

/// Paths and texts of the scenarios. They are a part of the program, so that it runs from any folder.
const SCENARIOS: [(&str, &str); 2] = [
    ("scenarios/paper.ron", include_str!("../../../scenarios/paper.ron")),
    ("scenarios/paper-calibrated.ron", include_str!("../../../scenarios/paper-calibrated.ron")),
];

/// The paper's experiment in each of its scenarios: with the printed constants, and with calibrated costs.
///
/// # Errors
/// None: the scenarios are given. A program that was started with policies of its own may lack one of
/// [`POLICIES`].
pub fn experiments(trials: u32) -> Result<Vec<Experiment>, Failure> {
    let overrides = Overrides {
        policies: Some(POLICIES.map(str::to_owned).to_vec()),
        trials: Some(trials),
        ..Overrides::default()
    };
    let experiment =
        |(path, text): (&str, &str)| Experiment::parse(text.to_owned(), Path::new(path), &overrides);
    SCENARIOS.into_iter().map(experiment).collect()
}
