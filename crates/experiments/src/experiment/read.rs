//! Reads scenarios as parts of an experiment, with what the command line sets in them.

use std::path::{Path, PathBuf};

use scenario::{Scenario, ScenarioFile, is_file, parse_ron, parse_tree, read_text};
use store::{Failure, refuse};
use teaming::Registry;

use super::file::SweepFile;
use super::setting::{checked, decides, overlapping};
use super::sweep_file::{Reading, from_sweep_file};
use super::{AnalysisPlan, Keep, Parts, Seeds};

/// The policy where none is named.
const RNE: &str = "RNE";

/// The first seed where none is given.
const FIRST_SEED: u64 = 1;

/// A scenario with fields set by `path=value`.
///
/// # Errors
/// An unknown field, or a value that does not fit the field or breaks a rule.
pub fn with_settings(scenario: &Scenario, settings: &[String]) -> Result<Scenario, Failure> {
    let mut file: ScenarioFile = (**scenario).clone();
    let (tree, mut earlier) = (scenario.tree(), Vec::new());
    for entry in settings {
        let (path, value) = entry
            .split_once('=')
            .ok_or_else(|| Failure::input(format!("--set: must be path=value, found {entry:?}")))?;
        let path = path.trim();
        if !decides(path) {
            refuse!(
                "--set: {path}: decides no number of a trial; --policies, --trials and --first-seed say what \
                 is run"
            );
        }
        file.set(path, value).map_err(Failure::input_at("--set"))?;
        if let Some(other) = overlapping(&tree, earlier.iter().copied(), path) {
            refuse!("--set: {path} and {other} set the same field");
        }
        earlier.push(path);
    }
    checked(file, "--set: ")
}

/// Refuses a text that is neither a scenario nor a sweep file. The files that it names are not looked at.
///
/// # Errors
/// What is wrong with the text.
pub(crate) fn check_form(text: &str, path: &Path) -> Result<(), Failure> {
    let tree = parse_tree(text, path).map_err(Failure::input)?;
    if tree.get("scenario").is_some() {
        return parse_ron::<SweepFile>(text, path).map(drop).map_err(Failure::input);
    }
    if tree.get("base").is_some() {
        return Ok(());
    }
    Scenario::parse(text, path).map(drop).map_err(Failure::input)
}

/// The sweep file that belongs to a scenario: `paper.sweep.ron` beside `paper.ron`.
pub fn companion(scenario: &Path) -> PathBuf {
    scenario.with_extension("sweep.ron")
}

/// The first policy and the first seed of a scenario's sweep.
///
/// # Errors
/// A companion that cannot be read.
pub fn defaults(scenario: &Path) -> Result<(String, u64), Failure> {
    let companion = companion(scenario);
    if !is_file(&companion) {
        return Ok((RNE.to_owned(), FIRST_SEED));
    }
    let text = read_text(&companion).map_err(Failure::input)?;
    let SweepFile { policies, first_seed, seeds, .. } =
        parse_ron(&text, &companion).map_err(Failure::input)?;
    let policy = policies.and_then(|policies| policies.into_iter().next());
    let listed = seeds.and_then(|seeds| seeds.first().copied());
    Ok((policy.unwrap_or_else(|| RNE.to_owned()), listed.or(first_seed).unwrap_or(FIRST_SEED)))
}

/// The sweep of a scenario: its companion's sweep, or one trial of RNE.
pub(super) fn from_scenario(
    text: String,
    path: &Path,
    registry: &Registry,
) -> Result<(Parts, Vec<Reading>), Failure> {
    let companion = companion(path);
    if is_file(&companion) {
        let sweep = read_text(&companion).map_err(Failure::input)?;
        let file: SweepFile = parse_ron(&sweep, &companion).map_err(Failure::input)?;
        if Path::new(&file.scenario).file_name() != path.file_name() {
            refuse!(
                "{}: scenario: must be \"{}\", whose sweep this is, found {:?}",
                companion.display(),
                path.file_name().unwrap_or_default().display(),
                file.scenario
            );
        }
        return from_sweep_file(sweep, &companion, None, registry);
    }
    let base = Scenario::parse(&text, path).map_err(Failure::input)?;
    let parts = Parts {
        name: base.name.clone(),
        given: text,
        axes: Vec::new(),
        policies: vec![RNE.to_owned()],
        registry: registry.clone(),
        trials: 1,
        seeds: Seeds::From(FIRST_SEED),
        is_checked: false,
        keep: Keep::default(),
        plan: AnalysisPlan::default(),
        program: None,
        base,
    };
    Ok((parts, Vec::new()))
}

/// The policies, with RNE replaced by every combination of the readings. Each combination is named by the
/// options that differ from the default.
pub(super) fn with_readings(policies: Vec<String>, readings: &[Reading], registry: &Registry) -> Vec<String> {
    let all_options = |text: &str| registry.make("RNE", text).ok().map(|made| made.options);
    let default = all_options("");
    let mut combinations = vec![Vec::new()];
    for (option, values) in readings {
        let mut longer = Vec::new();
        for combination in &combinations {
            for value in values {
                let is_default = all_options(&format!("({option}: {value})")) == default;
                let mut next: Vec<String> = combination.clone();
                next.extend((!is_default).then(|| format!("{option}: {value}")));
                longer.push(next);
            }
        }
        combinations = longer;
    }
    let named = |combination: &Vec<String>| {
        if combination.is_empty() { "RNE".to_owned() } else { format!("RNE({})", combination.join(", ")) }
    };
    let expand = |policy: String| {
        if policy.trim() == "RNE" { combinations.iter().map(named).collect() } else { vec![policy] }
    };
    policies.into_iter().flat_map(expand).collect()
}
