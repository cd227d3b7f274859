//! The native half of the Python package `usar`. What a user sees, with its documentation, is in `usar/`.
#![expect(clippy::doc_markdown, reason = "comments are docstrings")]
#![expect(clippy::needless_pass_by_value, reason = "Python hands over what it calls with")]

mod answer;
mod arrays;
mod errors;
mod policy;
mod rne;
mod scenario;
mod simulation;
mod sweep;
mod trial;
mod waiting;

use std::ffi::OsString;

use pyo3::prelude::*;

/// Runs the command `usar` with these words, the program first, and returns its exit status.
#[pyfunction]
fn command(py: Python<'_>, words: Vec<OsString>) -> u8 {
    let guard = policy::guard_words(py);
    py.detach(|| usar::run(&words, policies::standard(), guard))
}

/// Guards a program of a policy: the number of the process that started it, and the words of the program.
#[pyfunction]
fn guard(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| programs::guard(&words))
}

/// The module.
#[pymodule]
mod _usar {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::errors::{PolicyError, ScenarioError};
    #[pymodule_export]
    use super::rne::rne;
    #[pymodule_export]
    use super::scenario::{Scenario, ron};
    #[pymodule_export]
    use super::simulation::{Simulation, advance_all};
    #[pymodule_export]
    use super::sweep::sweep;
    #[pymodule_export]
    use super::trial::{group, run};
    #[pymodule_export]
    use super::{command, guard};

    #[pymodule_init]
    #[expect(clippy::unnecessary_wraps, reason = "initialisers may fail")]
    fn init(_module: &Bound<'_, PyModule>) -> PyResult<()> {
        usar::carry();
        Ok(())
    }
}
