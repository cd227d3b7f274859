//! What a sweep file asks of its results: which metrics come first, with which policy the others are
//! compared, and which differences matter. None of it changes the numbers of a trial.

use ron_fields::Fields;

use super::Experiment;
use super::file::SweepFile;
use crate::failure::Failure;

/// The questions of a sweep file. Empty for a scenario without a sweep file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Asks {
    /// The metrics that the sweep is about; empty for the metrics of the paper's tables.
    pub primary: Vec<String>,
    /// The policy with which the others are compared, if the sweep has it.
    pub baseline: Option<String>,
    /// For metrics, the largest difference that does not matter.
    pub margins: Vec<(String, f64)>,
    /// Expectations about the outcome, as written.
    pub expect: Vec<String>,
}

impl Experiment {
    /// The questions of the file from which this sweep was read.
    ///
    /// # Errors
    /// An unknown metric, or a margin that is not a number above 0, with the field.
    pub fn asks(&self) -> Result<Asks, Failure> {
        let is_sweep = Fields::of(&self.given).inside("").contains(&"scenario");
        let file: Option<SweepFile> = if is_sweep { ron_of(&self.given) } else { None };
        let Some(SweepFile { primary, baseline, margins, expect, .. }) = file else {
            return Ok(Asks::default());
        };
        let named = |field: &str, name: &str| {
            let place =
                self.metrics.named(name).map_err(|error| Failure::input(format!("{field}: {error}")))?;
            Ok::<String, Failure>(self.metrics[place].name.clone())
        };
        let primary = primary.iter().map(|name| named("primary", name)).collect::<Result<Vec<_>, _>>()?;
        let margin = |(name, margin): &(String, f64)| {
            if margin.is_finite() && *margin > 0.0 {
                return Ok((named("margins", name)?, *margin));
            }
            Err(Failure::input(format!("margins: {name}: must be a number above 0, found {margin}")))
        };
        let margins = margins.0.iter().map(margin).collect::<Result<Vec<_>, _>>()?;
        let has = |label: &String| self.policies.iter().any(|policy| policy.label == *label);
        Ok(Asks { primary, baseline: baseline.filter(has), margins, expect })
    }
}

fn ron_of(text: &str) -> Option<SweepFile> {
    let options = ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
    options.from_str(text).ok()
}
