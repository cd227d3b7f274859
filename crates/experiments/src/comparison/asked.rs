//! Which comparisons are made. The command line comes first, then the sweep file. Without either, a small
//! family is compared: the rescuees, in total and of each task, of every policy against the first.
//! `compare` and `report` both ask here and therefore agree.

use store::{Failure, refuse};

use super::{Choice, short};
use crate::experiment::Experiment;

/// The command line's choice of comparisons.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Wishes {
    /// Metrics, by name. Empty: the metrics that the sweep file names.
    pub metrics: Vec<String>,
    /// The policy with which the others are compared.
    pub baseline: Option<String>,
    /// `METRIC=VALUE`: the largest difference that does not matter.
    pub margins: Vec<String>,
    /// The only policies to compare; `None` for all.
    pub policies: Option<Vec<String>>,
}

/// Which comparisons are made together.
#[derive(Debug, Clone, PartialEq)]
pub struct Asked {
    /// Places of the metrics.
    pub metrics: Vec<usize>,
    /// Places of the main metrics that are not among `metrics`: their results are exploratory.
    pub exploratory: Vec<usize>,
    /// The policy with which the others are compared; `None` for all pairs.
    pub baseline: Option<String>,
    /// For metrics, the largest difference that does not matter.
    pub margins: Vec<(usize, f64)>,
    /// How many of these the command line names; the others are the sweep file's.
    pub margins_of_command: usize,
    /// The only policies to compare; `None` for all.
    pub policies: Option<Vec<String>>,
    /// Whether the command line or the sweep file names the metrics.
    pub is_declared: bool,
}

impl Asked {
    /// Resolves the command line's wishes and the sweep file.
    ///
    /// # Errors
    /// An unknown metric, a margin that is not a number above 0, or a margin with only one policy.
    pub fn of(experiment: &Experiment, wishes: &Wishes) -> Result<Self, Failure> {
        let plan = &experiment.plan;
        let catalogue = &experiment.metrics;
        let is_declared = !(wishes.metrics.is_empty() && plan.primary.is_empty());
        let metrics = if !wishes.metrics.is_empty() {
            catalogue.chosen(&wishes.metrics)?
        } else if is_declared {
            catalogue.chosen(&plan.primary)?
        } else {
            first_question(experiment)?
        };
        let mut margins = Vec::new();
        for text in &wishes.margins {
            let (place, value) = margin(experiment, text)?;
            let name = &catalogue[place].name;
            if margins.iter().any(|(known, _)| *known == place) {
                refuse!("--margin: {name} has two margins");
            }
            if !metrics.contains(&place) {
                refuse!("--margin: {name} is not compared here; --metric {name} compares it");
            }
            margins.push((place, value));
        }
        let of_command = margins.len();
        for (name, margin) in &plan.margins {
            let place = catalogue.named(name)?;
            if margins.iter().all(|(known, _)| *known != place) {
                margins.push((place, *margin));
            }
        }
        let is_compared =
            |label: &&str| wishes.policies.as_ref().is_none_or(|only| only.iter().any(|one| one == label));
        let labels = experiment.policies.iter().map(|policy| policy.label.as_str());
        let compared: Vec<&str> = labels.filter(is_compared).collect();
        if let ([only], false) = (&*compared, wishes.margins.is_empty()) {
            refuse!(
                "--margin: a margin is for the difference of two policies, and {only} is the only one here"
            );
        }
        let first = compared.first().filter(|_| !is_declared).map(|label| (*label).to_owned());
        let exploratory =
            catalogue.chosen(&[])?.into_iter().filter(|place| !metrics.contains(place)).collect();
        Ok(Self {
            metrics,
            exploratory,
            baseline: wishes.baseline.clone().or_else(|| plan.baseline.clone()).or(first),
            margins,
            margins_of_command: of_command,
            policies: wishes.policies.clone(),
            is_declared,
        })
    }

    /// The margins of the metrics that are compared, in a sentence that says who named them; empty without
    /// any.
    pub fn margins_in_words(&self, experiment: &Experiment) -> String {
        let of = |margins: &[(usize, f64)]| {
            let asked = margins.iter().filter(|(place, _)| self.metrics.contains(place));
            let named = asked
                .map(|(place, margin)| format!("{} {}", experiment.metrics[*place].name, short(*margin)));
            named.collect::<Vec<_>>().join(", ")
        };
        let (commanded, filed) = self.margins.split_at(self.margins_of_command);
        match [of(commanded), of(filed)] {
            [commanded, filed] if commanded.is_empty() && filed.is_empty() => String::new(),
            [commanded, filed] if filed.is_empty() => format!("Margins: {commanded} (--margin)."),
            [commanded, filed] if commanded.is_empty() => format!("Margins: {filed} (sweep file)."),
            [commanded, filed] => format!("Margins: {commanded} (--margin), {filed} (sweep file)."),
        }
    }

    /// The same comparisons as a [`Choice`].
    pub fn choice(&self) -> Choice<'_> {
        Choice {
            baseline: self.baseline.as_deref(),
            policies: self.policies.as_deref(),
            margins: &self.margins,
        }
    }
}

/// The metrics of a sweep that names none: rescuees, in total and of each task. With errands: errands done,
/// and the time.
fn first_question(experiment: &Experiment) -> Result<Vec<usize>, Failure> {
    let has_errands = !experiment.base.errands.is_empty();
    let mut metrics = experiment.metrics.declared(if has_errands { "errands_done" } else { "rescuees" });
    if has_errands {
        metrics.push(experiment.metrics.named("time")?);
    }
    // With one task, the task's metric equals the total.
    let tasks = metrics.len().saturating_sub(1);
    metrics.truncate(if tasks == 1 && !has_errands { 1 } else { metrics.len() });
    Ok(metrics)
}

fn margin(experiment: &Experiment, text: &str) -> Result<(usize, f64), Failure> {
    let bad =
        || Failure::input(format!("--margin: must be METRIC=VALUE with a value above 0, found {text:?}"));
    let (name, value) = text.split_once('=').ok_or_else(bad)?;
    let place = experiment.metrics.named(name.trim());
    let place = place.map_err(Failure::input_at("--margin"))?;
    let value = value.trim().parse::<f64>().ok().filter(|value| value.is_finite() && *value > 0.0);
    Ok((place, value.ok_or_else(bad)?))
}
