//! Which comparisons are made: what the command line says, else what the sweep file asks, else those of the
//! paper's tables. `compare` and `report` ask here, so that both say the same.

use super::Choice;
use crate::experiment::Experiment;
use crate::failure::Failure;

/// Which comparisons are made together.
#[derive(Debug, Clone, PartialEq)]
pub struct Asked {
    /// Places of the metrics.
    pub metrics: Vec<usize>,
    /// The policy with which the others are compared; none for all pairs.
    pub baseline: Option<String>,
    /// For metrics, the largest difference that does not matter.
    pub margins: Vec<(usize, f64)>,
    /// Whether the sweep file names the metrics.
    pub is_declared: bool,
}

impl Asked {
    /// From metrics, a baseline and margins (`METRIC=VALUE`) of the command line, and the sweep file.
    ///
    /// # Errors
    /// An unknown metric, or a margin that is not a number above 0.
    pub fn of(
        experiment: &Experiment,
        metrics: &[String],
        baseline: Option<&str>,
        margins: &[String],
    ) -> Result<Self, Failure> {
        let asks = experiment.asks()?;
        let is_declared = metrics.is_empty() && !asks.primary.is_empty();
        let chosen = experiment.metrics.chosen(if is_declared { &asks.primary } else { metrics })?;
        let mut all = Vec::new();
        for text in margins {
            all.push(margin(experiment, text)?);
        }
        for (name, margin) in &asks.margins {
            let place = experiment.metrics.named(name)?;
            if all.iter().all(|(known, _)| *known != place) {
                all.push((place, *margin));
            }
        }
        let baseline = baseline.map(str::to_owned).or(asks.baseline);
        Ok(Self { metrics: chosen, baseline, margins: all, is_declared })
    }

    /// The same as a choice, of some policies only.
    #[must_use]
    pub fn choice<'a>(&'a self, policies: Option<&'a [&'a str]>) -> Choice<'a> {
        Choice { baseline: self.baseline.as_deref(), policies, margins: &self.margins }
    }
}

fn margin(experiment: &Experiment, text: &str) -> Result<(usize, f64), Failure> {
    let bad =
        || Failure::input(format!("--margin: must be METRIC=VALUE with a value above 0, found {text:?}"));
    let (name, value) = text.split_once('=').ok_or_else(bad)?;
    let place = experiment.metrics.named(name.trim());
    let place = place.map_err(|error| Failure::input(format!("--margin: {error}")))?;
    let value = value.trim().parse::<f64>().ok().filter(|value| value.is_finite() && *value > 0.0);
    Ok((place, value.ok_or_else(bad)?))
}
