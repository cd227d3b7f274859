//! Scenarios.

use std::path::{Path, PathBuf};

use pyo3::exceptions::{PyRecursionError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use ron_tree::limits::{NESTING, TEXT_BYTES};
use scenario::{Problems, Scenario as Checked, ScenarioError, ScenarioFile};

use crate::errors::unusable;

/// A scenario of which every value was checked. It cannot be changed.
///
/// >>> from usar import Scenario
/// >>> Scenario.builtin("paper")
/// <usar.Scenario paper of 12 robots, 600 s>
/// >>> Scenario.builtin("paper").set(duration_s=-1)
/// Traceback (most recent call last):
///     ...
/// usar.ScenarioError: usar:/paper.ron: duration_s must be a number from 1 to 86400, found -1
#[pyclass(frozen, module = "usar._usar")]
pub struct Scenario {
    pub(crate) it: Checked,
    path: PathBuf,
}

#[pymethods]
impl Scenario {
    /// Read and check a file.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let (it, _) = Checked::load(&path).map_err(|error| unusable(py, &error))?;
        Ok(Self { it, path })
    }

    /// Read and check a text. `path` stands in messages, and says where the files are that the text names.
    #[staticmethod]
    #[pyo3(signature = (text, path=PathBuf::from("<text>")), text_signature = "(text, path='<text>')")]
    fn from_str(py: Python<'_>, text: &str, path: PathBuf) -> PyResult<Self> {
        let it = Checked::parse(text, &path).map_err(|error| unusable(py, &error))?;
        Ok(Self { it, path })
    }

    /// A scenario that the package has, by its name: `usar scenario list` has them.
    #[staticmethod]
    fn builtin(py: Python<'_>, name: &str) -> PyResult<Self> {
        let known =
            || PyValueError::new_err(format!("no scenario is called {name:?}; `usar scenario list` has all"));
        Self::load(py, usar::carried(name).ok_or_else(known)?)
    }

    /// The scenario with fields set, each by its path. Numbers, booleans, lists and None are those of Python;
    /// a text is RON, as after `--set`, so that a text in RON has quotes of its own.
    ///
    /// >>> from usar import Scenario
    /// >>> Scenario.builtin("paper").set(duration_s=60, **{"mission.belief_sharing": "WithNobody"})
    /// <usar.Scenario paper of 12 robots, 60 s>
    #[pyo3(signature = (**paths))]
    fn set(&self, py: Python<'_>, paths: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let mut file: ScenarioFile = (*self.it).clone();
        let invalid =
            |list| unusable(py, &ScenarioError::Invalid(Problems { path: self.path.clone(), list }));
        for (path, value) in paths.into_iter().flatten() {
            let (path, value): (String, String) = (path.extract()?, ron(&value)?);
            file.set(&path, &value).map_err(|problem| invalid(vec![*problem]))?;
        }
        let it = Checked::try_from(file).map_err(invalid)?;
        Ok(Self { it, path: self.path.clone() })
    }

    /// Name of the scenario.
    #[getter]
    fn name(&self) -> &str {
        &self.it.name
    }

    /// Where it was read.
    #[getter]
    fn path(&self) -> &Path {
        &self.path
    }

    /// Time of a trial, in seconds.
    #[getter]
    fn duration_s(&self) -> f64 {
        self.it.duration_s
    }

    /// Time of a step, in seconds.
    #[getter]
    fn step_s(&self) -> f64 {
        self.it.dt_s
    }

    /// Length and width of the arena, in metres.
    #[getter]
    fn arena(&self) -> [f64; 2] {
        self.it.arena_m
    }

    /// Number of robots, the most where it is drawn.
    #[getter]
    fn robots(&self) -> u32 {
        self.it.robots()
    }

    /// The whole scenario with every value, in RON.
    #[getter]
    fn text(&self) -> String {
        self.it.resolved()
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.it == other.it
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String, &Path))> {
        Ok((py.get_type::<Self>().getattr("from_str")?, (self.text(), &self.path)))
    }

    fn __repr__(&self) -> String {
        format!("<usar.Scenario {} of {} robots, {} s>", self.it.name, self.it.robots(), self.it.duration_s)
    }
}

/// A value of Python in RON. A text is taken as it is.
#[pyfunction]
pub fn ron(value: &Bound<'_, PyAny>) -> PyResult<String> {
    let mut text = String::new();
    write(&mut text, value, 0)?;
    Ok(text)
}

/// Writes a value that is within `depth` lists. A list may contain itself, and the same list many times.
fn write(text: &mut String, value: &Bound<'_, PyAny>, depth: usize) -> PyResult<()> {
    if depth > NESTING.count() {
        let message = format!("a value must have at most {} lists within one another", NESTING.count());
        return Err(PyRecursionError::new_err(message));
    }
    if text.len() > TEXT_BYTES.count() {
        let message = format!("a value must have at most {} bytes in RON", TEXT_BYTES.count());
        return Err(PyValueError::new_err(message));
    }
    if value.is_none() {
        text.push_str("None");
    } else if let Ok(is) = value.cast::<PyBool>() {
        text.push_str(if is.is_true() { "true" } else { "false" });
    } else if value.is_instance_of::<PyString>()
        || value.is_instance_of::<PyInt>()
        || value.is_instance_of::<PyFloat>()
    {
        text.push_str(&value.str()?.to_string());
    } else if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let [open, close] = if value.is_instance_of::<PyList>() { ['[', ']'] } else { ['(', ')'] };
        text.push(open);
        for (i, entry) in value.try_iter()?.enumerate() {
            text.push_str(if i > 0 { ", " } else { "" });
            write(text, &entry?, depth + 1)?;
        }
        text.push(close);
    } else {
        let number: PyResult<f64> = value.extract(); // those of numpy
        let wrong = "a value must be a number, a boolean, a text in RON, a list or None";
        text.push_str(&number.map_err(|_| PyTypeError::new_err(wrong))?.to_string());
    }
    Ok(())
}
