//! Arrays of numpy, which cannot be written to.

use parry2d::math::Vector;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// An array of this kind from its bytes, with so many columns; one column is no axis.
pub fn array<'py>(
    py: Python<'py>,
    kind: &str,
    columns: usize,
    bytes: Vec<u8>,
) -> PyResult<Bound<'py, PyAny>> {
    let array = py.import("numpy")?.call_method1("frombuffer", (PyBytes::new(py, &bytes), kind))?;
    if columns == 1 { Ok(array) } else { array.call_method1("reshape", ((-1, columns),)) }
}

/// An array with a row for each point.
pub fn points<const N: usize>(
    py: Python<'_>,
    points: impl Iterator<Item = [f32; N]>,
) -> PyResult<Bound<'_, PyAny>> {
    array(py, "float32", N, points.flatten().flat_map(f32::to_ne_bytes).collect())
}

/// So many finite vectors from an array with two columns.
pub fn vectors(given: &Bound<'_, PyAny>, count: usize) -> PyResult<Vec<Vector>> {
    let array = given.py().import("numpy")?.call_method1("asarray", (given, "float32"))?;
    let shape: Vec<usize> = array.getattr("shape")?.extract()?;
    if shape != [count, 2] {
        return Err(PyValueError::new_err(format!(
            "velocities must have the shape ({count}, 2), found {shape:?}"
        )));
    }
    let bytes = array.call_method0("tobytes")?;
    let bytes = bytes.cast::<PyBytes>()?.as_bytes();
    let number = |bytes: &[u8]| f32::from_ne_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    let vectors: Vec<Vector> =
        bytes.chunks_exact(8).map(|pair| Vector::new(number(&pair[..4]), number(&pair[4..]))).collect();
    match vectors.iter().position(|vector| !vector.is_finite()) {
        Some(robot) => Err(PyValueError::new_err(format!("the velocity of robot {robot} must be finite"))),
        None => Ok(vectors),
    }
}
