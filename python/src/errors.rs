//! What is raised in Python.

use experiments::Failure;
use experiments::experiment::SweepFileError;
use pyo3::exceptions::{PyException, PyKeyboardInterrupt, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pythonize::PythonizeError;
use scenario::{Location, ScenarioError as Unusable};

pyo3::create_exception!(usar, ScenarioError, PyValueError, "A scenario or a sweep file that cannot be used.");
pyo3::create_exception!(usar, PolicyError, PyRuntimeError, "A policy that did not answer a question.");

/// Raises a failure of the laboratory as the exception of its kind.
pub fn raised(py: Python<'_>, failure: Failure) -> PyErr {
    let message = failure.to_string();
    match failure {
        Failure::Input(cause) => {
            let scenario = cause.downcast_ref().map(Unusable::place);
            let sweep = || cause.downcast_ref().and_then(SweepFileError::place).cloned();
            match scenario.or_else(sweep) {
                Some(place) => at(py, message, place),
                None => PyValueError::new_err(message),
            }
        }
        Failure::Run(_) => PyRuntimeError::new_err(message),
        Failure::Storage(_) | Failure::ClosedOutput => PyOSError::new_err(message),
        Failure::Interrupted(_) => PyKeyboardInterrupt::new_err(message),
    }
}

/// Raises what is wrong with a scenario, with the file, line and field of the first problem.
pub fn unusable(py: Python<'_>, error: &Unusable) -> PyErr {
    at(py, error.to_string(), error.place())
}

fn at(py: Python<'_>, message: String, Location { file, line, field }: Location) -> PyErr {
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

/// Raises that a question cannot be read: a `ValueError` where its values are wrong.
pub fn unread(py: Python<'_>, error: PythonizeError) -> PyErr {
    let raised = PyErr::from(error);
    let is_bare = raised.get_type(py).is(py.get_type::<PyException>());
    if is_bare { PyValueError::new_err(format!("the question: {}", raised.value(py))) } else { raised }
}
