//! One file per verb of the command line.

pub(crate) mod check;
pub(crate) mod group;
pub(crate) mod run;
pub(crate) mod sweep;
pub(crate) mod trust;

use std::path::Path;

use usar_sim::scenario::Scenario;

use crate::failure::Failure;

/// Version of the JSON that the commands print.
pub(crate) const SCHEMA_VERSION: u32 = 1;

/// Loads a scenario and its text, or says in full what is wrong with it.
pub(crate) fn load(path: &Path) -> Result<(Scenario, String), Failure> {
    Scenario::load(path).map_err(Failure::input)
}

/// Numbers separated by commas.
pub(crate) fn numbers(flag: &str, text: &str) -> Result<Vec<f64>, Failure> {
    let number = |(i, part): (usize, &str)| {
        part.trim().parse::<f64>().map_err(|_| {
            Failure::input(format!("{flag}: entry {} must be a number, found {:?}", i + 1, part.trim()))
        })
    };
    text.split(',').enumerate().map(number).collect()
}
