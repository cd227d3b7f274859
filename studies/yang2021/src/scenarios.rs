//! The runs of the paper's experiment: its policies, and the scenarios that stand for its world.

use std::path::Path;

use experiments::Failure;
use experiments::experiment::{Experiment, Overrides};
use ron_tree::Node;
use teaming::Registry;

/// Policies of the paper.
pub const POLICIES: [&str; 4] = ["RNE", "DIS", "ENG", "HP_DIS"];

/// Number of trials in the paper.
pub const PAPERS_TRIALS: u32 = 10;

// The scenarios are part of the program, so that it runs from any folder.
const PRINTED: &str = include_str!("../../../scenarios/paper.ron");
const SWEEP: &str = include_str!("../../../scenarios/paper.sweep.ron");
const CALIBRATED: &str = include_str!("../../../scenarios/paper-calibrated.ron");

/// For each reading of when a tired robot rests, the world that fits best, as a variant of the chosen one.
const READINGS: &str = include_str!("../../../scenarios/sweeps/when-a-robot-rests.ron");

/// The worlds among them that the data cannot tell apart from the chosen one: nearest to the records in at
/// least 5 % of the draws of `studies/yang2021/docs/calibration/choice.csv`.
const NOT_TOLD_APART: [&str; 1] = ["when-home-1"];

/// A world of another reading gets this fraction (one over it) of the trials of the other worlds.
const ALTERNATIVE_SHARE: u32 = 4;

/// The role of a scenario in the study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// The constants that the paper prints.
    Printed,
    /// Costs fitted to the authors' recorded trials of the distance baseline: the chosen fit.
    Calibrated,
    /// The best fit under another reading, which the recorded trials cannot tell apart from the chosen one.
    Alternative,
    /// The best fit under another reading, which fits worse.
    FitsWorse,
}

impl Standing {
    /// Whether the world is one of those that the recorded trials leave possible.
    pub fn is_in_ensemble(self) -> bool {
        matches!(self, Self::Calibrated | Self::Alternative)
    }

    /// Whether the world is shown by itself; of the others, only verdicts and ranges are.
    pub fn is_main(self) -> bool {
        matches!(self, Self::Printed | Self::Calibrated)
    }
}

/// The paper's experiment in one scenario.
pub struct World {
    /// The role of the scenario.
    pub standing: Standing,
    /// The sweep that is run in it.
    pub experiment: Experiment,
}

/// The paper's experiment in each scenario: with the printed constants, with calibrated costs, and in the
/// best world of every other reading of when a tired robot rests, with a quarter of the trials.
///
/// # Errors
/// A policy of the paper is not in the registry.
pub fn worlds(trials: u32, registry: &Registry) -> Result<Vec<World>, Failure> {
    let world = |standing, path: &str, text: &str, overrides: &Overrides| {
        let experiment = Experiment::parse(text.to_owned(), Path::new(path), overrides, registry)?;
        Ok::<World, Failure>(World { standing, experiment })
    };
    let printed = world(Standing::Printed, "scenarios/paper.ron", PRINTED, &overrides(trials, Vec::new()))?;
    let calibrated = |standing, overrides: &Overrides| {
        world(standing, "scenarios/paper-calibrated.ron", CALIBRATED, overrides)
    };
    let mut worlds = vec![printed, calibrated(Standing::Calibrated, &overrides(trials, Vec::new()))?];
    let few = (trials / ALTERNATIVE_SHARE).max(PAPERS_TRIALS);
    // The variant without changes is the calibrated world itself.
    for (name, settings) in variants(READINGS).into_iter().filter(|(_, settings)| !settings.is_empty()) {
        let is_alternative = NOT_TOLD_APART.contains(&name.as_str());
        let standing = if is_alternative { Standing::Alternative } else { Standing::FitsWorse };
        let mut world = calibrated(standing, &overrides(few, settings))?;
        world.experiment.name = format!("{}-{name}", world.experiment.name);
        worlds.push(world);
    }
    Ok(worlds)
}

fn overrides(trials: u32, set: Vec<String>) -> Overrides {
    let policies = Some(POLICIES.map(str::to_owned).to_vec());
    Overrides { policies, trials: Some(trials), set, ..Overrides::default() }
}

/// The largest differences that do not matter, by metric, as the paper's sweep file declares them.
pub fn margins() -> Vec<(String, f64)> {
    let margin =
        |(key, value): &(Node, Node)| Some((key.as_text()?.to_owned(), value.as_word()?.parse().ok()?));
    entries(SWEEP, "margins").iter().filter_map(margin).collect()
}

/// The keys and the values of a map in the text of a sweep file.
fn entries(sweep: &str, field: &str) -> Vec<(Node, Node)> {
    let tree = Node::parse(sweep).ok();
    tree.and_then(|tree| Some(tree.get(field)?.fields().to_vec())).unwrap_or_default()
}

/// Names of variants of a sweep file, and their settings as `path=value`.
fn variants(sweep: &str) -> Vec<(String, Vec<String>)> {
    let plain = |key: &Node| key.as_text().unwrap_or_default().to_owned();
    let setting = |(path, value): &(Node, Node)| format!("{}={value}", plain(path));
    let variants = entries(sweep, "variants").into_iter();
    variants.map(|(name, set)| (plain(&name), set.fields().iter().map(setting).collect())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variants_of_a_sweep_file_are_worlds_with_names_and_settings() {
        let text = "(name: \"w\", variants: {\"two\": {\"mission.rest_s\": 3.0, \"a.b[0]\": \
            At(1)}, \"three\": {\"c\": 1}})";
        let expected = [("two", vec!["mission.rest_s=3.0", "a.b[0]=At(1)"]), ("three", vec!["c=1"])];
        let found = variants(text);
        let found: Vec<(&str, Vec<&str>)> = found
            .iter()
            .map(|(name, set)| (name.as_str(), set.iter().map(String::as_str).collect()))
            .collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn margins_are_those_of_the_papers_sweep_file() {
        let expected =
            ["rescuees.total", "rescuees.hard", "rescuees.easy"].map(|name| (name.to_owned(), 5.0));
        assert_eq!(margins(), expected);
    }

    #[test]
    fn other_readings_have_names_of_their_own_and_fewer_trials() {
        let worlds = worlds(200, &policies::standard()).unwrap();
        assert_eq!(worlds[0].standing, Standing::Printed);
        assert_eq!(worlds[1].standing, Standing::Calibrated);
        let others: Vec<Standing> = worlds[2..].iter().map(|world| world.standing).collect();
        let [alternative, worse] = [Standing::Alternative, Standing::FitsWorse];
        assert_eq!(others, [alternative, worse, worse, worse, worse]);
        let names: std::collections::BTreeSet<&str> =
            worlds.iter().map(|world| world.experiment.name.as_str()).collect();
        assert_eq!(names.len(), worlds.len());
        assert!(worlds[2..].iter().all(|world| world.experiment.trials == 50));
    }
}
