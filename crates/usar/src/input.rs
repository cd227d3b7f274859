//! What commands read: scenarios and folders of sweeps.

use std::collections::BTreeSet;
use std::path::Path;

use experiments::Failure;
use experiments::experiment::Experiment;
use experiments::sweep::folder::Folder;
use rne_core::Registry;
use usar_sim::scenario::Scenario;

use crate::running::tell;

/// Loads a scenario and its text. The error has all problems; warnings of a valid scenario go to stderr.
pub(crate) fn load(path: &Path) -> Result<(Scenario, String), Failure> {
    let (scenario, text) = Scenario::load(path).map_err(Failure::input)?;
    tell_warnings(&scenario, &text, path);
    Ok((scenario, text))
}

/// Tells the warnings of a valid scenario on stderr.
pub(crate) fn tell_warnings(scenario: &Scenario, text: &str, path: &Path) {
    tell_warnings_of_all([scenario], text, path);
}

/// Tells the warnings of several scenarios on stderr, each once.
pub(crate) fn tell_warnings_of_all<'s>(
    scenarios: impl IntoIterator<Item = &'s Scenario>,
    text: &str,
    path: &Path,
) {
    let mut told = BTreeSet::new();
    for warning in scenarios.into_iter().flat_map(|scenario| scenario.warnings(text)) {
        let line = warning.line.map_or(String::new(), |line| format!(":{line}"));
        let note = format!("note: {}{line}: {warning}", path.display());
        if told.insert(note.clone()) {
            tell(note);
        }
    }
}

/// Tells on stderr what is doubtful about the policies of a sweep.
pub(crate) fn tell_doubts(experiment: &Experiment, path: &Path) {
    experiment.doubts().into_iter().for_each(|doubt| tell(format_args!("note: {}: {doubt}", path.display())));
}

/// Reads the folder of a sweep. A note on stderr tells if trials are missing.
pub(crate) fn read_sweep(path: &Path, registry: &Registry) -> Result<Folder, Failure> {
    let folder = Folder::read(path, registry)?;
    if !folder.manifest().is_complete {
        let (there, of) = (folder.results().len(), folder.experiment().keys(None).count());
        let path = path.display();
        tell(format_args!("note: {path}: the sweep is not complete: {there} of {of} trials are there"));
    }
    Ok(folder)
}

/// Fails if a trial of a sweep gave no numbers.
pub(crate) fn check_trials<'f>(folders: impl IntoIterator<Item = &'f Folder>) -> Result<(), Failure> {
    let results = folders.into_iter().flat_map(|folder| folder.results().values());
    let failures: Vec<&str> = results.filter_map(|measured| measured.failure.as_deref()).collect();
    if failures.is_empty() { Ok(()) } else { Err(Failure::run(failures.join("\n"))) }
}
