//! Minimises a noisy function without derivatives: CMA-ES (Hansen 2016, "The CMA Evolution Strategy: A
//! Tutorial", arXiv 1604.00772), from the crate `cmaes`, over a box that is mirrored at its ends. The
//! search is deterministic. An interrupted search is repeated from its start, with the values in a log
//! instead of new evaluations.

use std::sync::atomic::{AtomicBool, Ordering};

use cmaes::{CMAESOptions, DVector};
use store::Failure;

use super::Parameter;

/// The value of a point that cannot be evaluated.
pub const WORST: f64 = 1e9;

/// Settings of a search.
#[derive(Debug, Clone, Copy)]
pub struct Descent {
    /// Candidates to evaluate, including the start. The last generation is completed.
    pub evaluations: usize,
    /// Seed of the search.
    pub seed: u64,
    /// Standard deviation of the first candidates, in units of each range.
    pub first_step: f64,
}

impl Descent {
    /// Searches from a start until this many candidates were evaluated or the search no longer improves.
    /// Returns false if `stop` interrupted it. `objective` returns the value at a point, or `None` if
    /// `stop` interrupted the evaluation.
    ///
    /// # Errors
    /// Those of `objective`.
    pub fn search(
        &self,
        free: &[Parameter],
        start: &[f64],
        stop: &AtomicBool,
        mut objective: impl FnMut(Vec<f64>) -> Result<Option<f64>, Failure>,
    ) -> Result<bool, Failure> {
        if objective(start.to_vec())?.is_none() {
            return Ok(false);
        }
        let places: Vec<f64> = free.iter().zip(start).map(|(free, value)| free.place(*value)).collect();
        let trouble = std::cell::Cell::new(None);
        let mut at = |x: &DVector<f64>| {
            let values: Vec<f64> = free.iter().zip(x.iter()).map(|(free, x)| free.value(*x)).collect();
            objective(values).unwrap_or_else(|failure| {
                trouble.set(Some(failure));
                None
            })
        };
        let options = CMAESOptions::new(places, self.first_step)
            .seed(self.seed)
            .max_function_evals(self.evaluations.saturating_sub(1));
        let mut search = options
            .build(|x: &DVector<f64>| at(x).unwrap_or(WORST))
            .map_err(|_| Failure::run("the search has no free parameter"))?;
        while search.next().is_none() {
            if let Some(failure) = trouble.take() {
                return Err(failure);
            }
            if stop.load(Ordering::Relaxed) {
                return Ok(false);
            }
        }
        trouble.take().map_or(Ok(!stop.load(Ordering::Relaxed)), Err)
    }
}
