//! Scenarios.

use std::path::{Path, PathBuf};

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use usar_sim::scenario::{Problems, Scenario as Checked, ScenarioError, ScenarioFile};

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

    /// The scenario with fields set, each by its path. Numbers, booleans, lists and None are those of Python; a
    /// text is RON, as after `--set`, so that a text in RON has quotes of its own.
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
        self.it.step_s()
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
    let listed = |entries: PyResult<Vec<String>>| Ok(format!("[{}]", entries?.join(", ")));
    if value.is_none() {
        return Ok("None".to_owned());
    }
    if let Ok(is) = value.cast::<PyBool>() {
        return Ok(is.is_true().to_string());
    }
    if value.is_instance_of::<PyString>()
        || value.is_instance_of::<PyInt>()
        || value.is_instance_of::<PyFloat>()
    {
        return Ok(value.str()?.to_string());
    }
    if let Ok(list) = value.cast::<PyList>() {
        return listed(list.iter().map(|entry| ron(&entry)).collect());
    }
    if let Ok(tuple) = value.cast::<PyTuple>() {
        let entries = tuple.iter().map(|entry| ron(&entry)).collect::<PyResult<Vec<_>>>()?;
        return Ok(format!("({})", entries.join(", ")));
    }
    let wrong = || PyTypeError::new_err("a value must be a number, a boolean, a text in RON, a list or None");
    let number: f64 = value.extract().map_err(|_| wrong())?; // those of numpy
    Ok(number.to_string())
}
