//! Fields of scenarios that a sweep or the command line sets.

use ron_tree::{Node, Problem};
use scenario::{Scenario, ScenarioFile};

use store::Failure;

/// A scenario of this file; `prefix` stands before each problem.
///
/// # Errors
/// The rules that the file breaks.
pub(super) fn checked(file: ScenarioFile, prefix: &str) -> Result<Scenario, Failure> {
    Scenario::try_from(file).map_err(|problems| {
        let line = |p: &Problem| format!("{prefix}{p}");
        Failure::input(problems.iter().map(line).collect::<Vec<_>>().join("\n"))
    })
}

/// Whether a field decides numbers: not the scenario's name, its description, nor `only_policy`.
pub(super) fn decides(path: &str) -> bool {
    let first = path.split(['.', '[']).next().unwrap_or_default();
    !["name", "description", "only_policy"].contains(&first)
}

/// Whether a field is this one, or a part of it, by whatever names.
pub(super) fn is_part(tree: &Node, field: &str, whole: &str) -> bool {
    let [field, whole] = [field, whole].map(|path| tree.canonical(path));
    field.strip_prefix(&*whole).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// Of earlier paths, the one that is this field, a part of it, or has it as a part.
pub(super) fn overlapping<'p>(
    tree: &Node,
    mut earlier: impl Iterator<Item = &'p str>,
    path: &str,
) -> Option<&'p str> {
    earlier.find(|other| is_part(tree, path, other) || is_part(tree, other, path))
}
