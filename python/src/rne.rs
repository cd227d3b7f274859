//! Relative Needs Entropy.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rne_core::{NeedDistribution, NeedVector, NeedWeights, NeedsError, relative_entropy};

/// Relative Needs Entropy of one robot towards another, in nats: infinite where the trustee lacks a need that
/// the trustor has. `weights` are those of the needs; without them, all are equal.
///
/// >>> import usar
/// >>> round(usar.rne([80, 20], [50, 50]), 6)
/// 0.192745
#[pyfunction]
#[pyo3(signature = (trustor, trustee, weights=None))]
pub fn rne(trustor: Vec<f64>, trustee: Vec<f64>, weights: Option<Vec<f64>>) -> PyResult<f64> {
    let weights = weights.unwrap_or_else(|| vec![1.0; trustor.len()]);
    let value = || -> Result<f64, NeedsError> {
        let weights = NeedWeights::new(weights)?;
        let [from, to] = [trustor, trustee].map(|needs| {
            NeedVector::new(needs).and_then(|needs| NeedDistribution::of_agent(&needs, &weights))
        });
        Ok(relative_entropy(&from?, &to?)?.nats().unwrap_or(f64::INFINITY))
    };
    value().map_err(|error| PyValueError::new_err(error.to_string()))
}
