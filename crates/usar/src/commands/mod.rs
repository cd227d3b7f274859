//! One file for each command.

mod asked;
pub(crate) mod calibrate;
pub(crate) mod check;
pub(crate) mod choose;
mod chosen;
pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod doctor;
pub(crate) mod draw;
mod drawn;
pub(crate) mod estimate;
mod explored;
pub(crate) mod export;
mod family;
pub(crate) mod figure;
pub(crate) mod fmt;
pub(crate) mod fork;
pub(crate) mod group;
pub(crate) mod list;
pub(crate) mod man;
mod measured_by;
pub(crate) mod merge;
pub(crate) mod new;
pub(crate) mod oracle;
mod output;
mod precision;
pub(crate) mod readings;
pub(crate) mod regret;
pub(crate) mod render;
pub(crate) mod report;
pub(crate) mod reproduce;
pub(crate) mod resolve;
pub(crate) mod run;
pub(crate) mod schema;
pub(crate) mod search;
pub(crate) mod sensitivity;
mod shown;
mod slurm;
mod snapshot;
pub(crate) mod sorting;
pub(crate) mod status;
pub(crate) mod submit;
pub(crate) mod sweep;
pub(crate) mod test;
pub(crate) mod tidy;
mod trials;
pub(crate) mod trust;
pub(crate) mod verify;
pub(crate) mod view;
pub(crate) mod why;

use std::path::Path;

use experiments::Failure;
use experiments::sweep::folder::Folder;
use rne_core::Registry;
use usar_sim::scenario::Scenario;

use crate::bad_value::BadValue;
use crate::running::tell;

use shown::print_table;
pub(crate) use shown::{ShownArguments, sentences};

/// Version of the JSON that the commands print.
pub(crate) const SCHEMA_VERSION: u32 = 1;

/// Loads a scenario and its text. The error has all problems; oddities of a valid scenario go to stderr.
pub(crate) fn load(path: &Path) -> Result<(Scenario, String), Failure> {
    let (scenario, text) = Scenario::load(path).map_err(Failure::input)?;
    for odd in scenario.oddities(&text) {
        let line = odd.line.map_or(String::new(), |line| format!(":{line}"));
        tell(format_args!("note: {}{line}: {odd}", path.display()));
    }
    Ok((scenario, text))
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

/// Parses a time interval from the command line.
pub(crate) fn seconds(text: &str) -> Result<f64, BadValue> {
    let seconds = text.parse().ok().filter(|seconds| (0.001..=100_000.0).contains(seconds));
    seconds.ok_or_else(|| BadValue::new("a number from 0.001 to 100000", text))
}

/// Parses numbers separated by commas.
pub(crate) fn numbers(flag: &str, text: &str) -> Result<Vec<f64>, Failure> {
    let number = |(i, part): (usize, &str)| {
        part.trim().parse::<f64>().map_err(|_| {
            Failure::input(format!("{flag}: entry {} must be a number, found {:?}", i + 1, part.trim()))
        })
    };
    text.split(',').enumerate().map(number).collect()
}
