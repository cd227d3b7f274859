//! What is raised in Python.

use experiments::Failure;
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use usar_sim::scenario::{Problem, Problems, ScenarioError as Unusable};

pyo3::create_exception!(usar, ScenarioError, PyValueError, "A scenario that cannot be used.");
pyo3::create_exception!(usar, PolicyError, PyRuntimeError, "A policy that did not answer a question.");

/// Raises a failure of the laboratory as the exception of its kind.
pub fn raised(failure: Failure) -> PyErr {
    let message = failure.to_string();
    match failure {
        Failure::Input(_) => PyValueError::new_err(message),
        Failure::Run(_) => PyRuntimeError::new_err(message),
        Failure::Storage(_) | Failure::ClosedOutput => PyOSError::new_err(message),
        Failure::Interrupted(_) => PyKeyboardInterrupt::new_err(message),
    }
}

/// Raises what is wrong with a scenario, with the file, line and field of the first problem.
pub fn unusable(py: Python<'_>, error: Unusable) -> PyErr {
    let message = error.to_string();
    let (file, line, field) = match error {
        Unusable::Unreadable { path, .. } => (path, None, None),
        Unusable::Malformed { path, source } => (path, Some(source.line), None),
        Unusable::Invalid(Problems { path, list }) => match list.into_iter().next() {
            Some(Problem { file, line, field, .. }) => (file.unwrap_or(path), line, Some(field)),
            None => (path, None, None),
        },
    };
    let raised = ScenarioError::new_err(message);
    let value = raised.value(py);
    let set = value.setattr("file", file.display().to_string()).and_then(|()| value.setattr("line", line));
    set.and_then(|()| value.setattr("field", field)).map_or_else(|error| error, |()| raised)
}

/// Raises that a policy did not answer, with the cause.
pub fn unanswered(py: Python<'_>, message: String, [seed, round]: [Option<u64>; 2], policy: &str) -> PyErr {
    let raised = PolicyError::new_err(message);
    let value = raised.value(py);
    let set = value.setattr("policy", policy).and_then(|()| value.setattr("seed", seed));
    set.and_then(|()| value.setattr("round", round)).map_or_else(|error| error, |()| raised)
}
