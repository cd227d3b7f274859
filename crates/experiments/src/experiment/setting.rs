//! Fields of scenarios that a sweep or the command line sets.

use ron_fields::Fields;
use usar_sim::scenario::{Problem, Scenario, ScenarioFile};

use crate::failure::Failure;

/// The path of a field with indices instead of the names of list entries: `roles[0].speed_mps` for
/// `roles.carrier.speed_mps`. Of a field that the scenario's text leaves out, the part that is there has
/// indices.
pub(super) fn canonical(scenario: &Scenario, path: &str) -> String {
    let text = scenario.resolved();
    let fields = Fields::of(&text);
    let mut ends: Vec<usize> = path.match_indices(['.', '[']).map(|(end, _)| end).collect();
    ends.push(path.len());
    let known = ends.into_iter().rev().find_map(|end| Some((end, fields.canonical(&path[..end])?)));
    known.map_or_else(|| path.to_owned(), |(end, part)| part + &path[end..])
}

/// A scenario of this file; `prefix` stands before each problem.
///
/// # Errors
/// The rules that the file breaks.
pub(super) fn checked(file: ScenarioFile, prefix: &str) -> Result<Scenario, Failure> {
    Scenario::try_from(file).map_err(|problems| {
        let line = |p: &Problem| format!("{prefix}{p}");
        Failure::Input(problems.iter().map(line).collect::<Vec<_>>().join("\n"))
    })
}

/// Whether a field decides numbers: not the scenario's name, its description, nor `only_policy`.
pub(super) fn decides(path: &str) -> bool {
    let first = path.split(['.', '[']).next().unwrap_or_default();
    !["name", "description", "only_policy"].contains(&first)
}
