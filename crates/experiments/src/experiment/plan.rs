//! The analysis plan of a sweep file: which metrics come first, with which policy the others are compared,
//! and which differences matter. None of it changes the numbers of a trial.

use ron_tree::Node;

use super::file::SweepFile;
use crate::metric::Catalogue;
use store::Failure;

/// The analysis plan of a sweep. Empty for a scenario without a sweep file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct AnalysisPlan {
    /// The metrics that the sweep is about; empty for the metrics of the paper's tables.
    pub primary: Vec<String>,
    /// The policy with which the others are compared, if the sweep has it.
    pub baseline: Option<String>,
    /// For metrics, the largest difference that does not matter.
    pub margins: Vec<(String, f64)>,
    /// Expectations about the outcome, as written.
    pub expect: Vec<String>,
}

impl AnalysisPlan {
    /// The plan as it is written.
    pub(super) fn of(file: &SweepFile) -> Self {
        let SweepFile { primary, baseline, margins, expect, .. } = file;
        let (primary, baseline, expect) = (primary.clone(), baseline.clone(), expect.clone());
        Self { primary, baseline, margins: margins.0.clone(), expect }
    }

    /// The plan in the text of a sweep file; empty for another text.
    pub(crate) fn in_text(text: &str) -> Self {
        let tree = Node::parse(text).ok().filter(|tree| tree.get("scenario").is_some());
        let file = tree.and_then(|tree| tree.read_as().ok());
        file.map_or_else(Self::default, |file| Self::of(&file))
    }

    /// The plan with the full names of its metrics.
    ///
    /// # Errors
    /// An unknown metric, or a margin that is not a number above 0, with the field.
    pub(super) fn checked(self, metrics: &Catalogue) -> Result<Self, Failure> {
        let named = |field: &str, name: &str| {
            let place = metrics.named(name).map_err(Failure::input_at(field))?;
            Ok::<String, Failure>(metrics[place].name.clone())
        };
        let primary = self.primary.iter().map(|name| named("primary", name)).collect::<Result<_, _>>()?;
        let margin = |(name, margin): &(String, f64)| {
            if margin.is_finite() && *margin > 0.0 {
                return Ok((named("margins", name)?, *margin));
            }
            Err(Failure::input(format!("margins: {name}: must be a number above 0, found {margin}")))
        };
        let margins = self.margins.iter().map(margin).collect::<Result<_, _>>()?;
        Ok(Self { primary, margins, ..self })
    }
}
