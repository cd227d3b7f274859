//! What commands read: scenarios and folders of sweeps.

use std::collections::BTreeSet;
use std::path::Path;

use experiments::Failure;
use experiments::experiment::{Case, Experiment};
use experiments::sweep::folder::Folder;
use ron_tree::Node;
use scenario::{Problem, Scenario};
use teaming::Registry;
use usar_sim::model::Layout;

use crate::running::tell;

/// Loads a scenario and its text. The error has all problems; warnings of a valid scenario go to stderr.
///
/// # Errors
/// All problems of the file.
pub fn load(path: &Path) -> Result<(Scenario, String), Failure> {
    let (scenario, text) = Scenario::load(path).map_err(Failure::input)?;
    tell_warnings(&scenario, &text, path);
    Ok((scenario, text))
}

/// Tells the warnings of a valid scenario on stderr.
pub fn tell_warnings(scenario: &Scenario, text: &str, path: &Path) {
    tell_warnings_of_all([scenario], text, path);
}

/// Tells the warnings of several scenarios on stderr, each once.
pub fn tell_warnings_of_all<'s>(scenarios: impl IntoIterator<Item = &'s Scenario>, text: &str, path: &Path) {
    tell_each(scenarios.into_iter().flat_map(|scenario| scenario.warnings(text)), path);
}

/// Tells what robots of the first trial of each case cannot reach on stderr.
pub fn tell_out_of_reach(experiment: &Experiment, path: &Path) {
    let tree = Node::parse(&experiment.given).ok();
    let seed = experiment.seed(1);
    let of_case = |case: &Case| {
        let scenario = case.scenario.of_trial(seed).ok()?;
        Some(Layout::sample(&scenario, seed).ok()?.out_of_reach(&scenario))
    };
    let all = experiment.cases.iter().filter_map(of_case).flatten();
    let placed = all
        .map(|problem| Problem { line: tree.as_ref().and_then(|tree| tree.line(&problem.field)), ..problem });
    tell_each(placed, path);
}

/// Tells warnings on stderr, each once.
fn tell_each(warnings: impl IntoIterator<Item = Problem>, path: &Path) {
    let mut told = BTreeSet::new();
    for warning in warnings {
        let line = warning.line.map_or(String::new(), |line| format!(":{line}"));
        let note = format!("note: {}{line}: {warning}", path.display());
        if told.insert(note.clone()) {
            tell(note);
        }
    }
}

/// Tells on stderr what is doubtful about the policies of a sweep.
pub fn tell_doubts(experiment: &Experiment, path: &Path) {
    experiment.doubts().into_iter().for_each(|doubt| tell(format_args!("note: {}: {doubt}", path.display())));
}

/// Reads the folder of a sweep. A note on stderr tells if trials are missing.
///
/// # Errors
/// The folder is not one of a sweep of these sources.
pub fn read_sweep(path: &Path, registry: &Registry) -> Result<Folder, Failure> {
    let folder = Folder::read(path, registry)?;
    if !folder.manifest().is_complete {
        let (there, of) = (folder.results().len(), folder.experiment().keys(None).count());
        let path = path.display();
        tell(format_args!("note: {path}: the sweep is not complete: {there} of {of} trials are there"));
    }
    Ok(folder)
}

/// Fails if a trial of a sweep gave no numbers.
///
/// # Errors
/// A trial failed.
pub fn check_trials<'f>(folders: impl IntoIterator<Item = &'f Folder>) -> Result<(), Failure> {
    let results = folders.into_iter().flat_map(|folder| folder.results().values());
    let failures: Vec<&str> = results.filter_map(|measured| measured.failure.as_deref()).collect();
    if failures.is_empty() { Ok(()) } else { Err(Failure::run(failures.join("\n"))) }
}
