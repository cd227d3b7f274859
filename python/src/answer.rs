//! Questions as Python sees them, and the groups that it answers.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use pythonize::pythonize;
use teaming::{Assignment, Question};

/// A question as a dict: what docs/schemas/question.schema.json describes.
pub fn asked<'py>(py: Python<'py>, question: &Question) -> PyResult<Bound<'py, PyAny>> {
    Ok(pythonize(py, question)?)
}

/// The groups of an answer: a list with the ids of each task's group, or a dict with `groups` and `idle`.
pub fn groups(answer: &Bound<'_, PyAny>) -> PyResult<Assignment> {
    let Ok(fields) = answer.cast::<PyDict>() else { return Ok(Assignment::new(lists(answer)?)) };
    let field = |name| fields.get_item(name).map(|value| value.filter(|value| !value.is_none()));
    let groups = field("groups")?.map_or_else(|| Ok(Vec::new()), |groups| lists(&groups))?;
    let idle = field("idle")?.map_or_else(|| Ok(Vec::new()), |idle| ids(&idle))?;
    Ok(Assignment { groups, idle }.sorted())
}

fn lists(groups: &Bound<'_, PyAny>) -> PyResult<Vec<Vec<u32>>> {
    groups.try_iter()?.map(|group| ids(&group?)).collect()
}

fn ids(group: &Bound<'_, PyAny>) -> PyResult<Vec<u32>> {
    if group.is_none() {
        return Ok(Vec::new());
    }
    group.try_iter()?.map(|id| id?.extract()).collect()
}
