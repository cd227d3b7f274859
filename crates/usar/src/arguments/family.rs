//! What is compared.

use experiments::comparison::{Asked, Wishes};
use experiments::experiment::Experiment;

use super::PoliciesArgument;
use crate::prelude::*;

/// Metrics and policies to compare.
#[derive(Debug, Args)]
pub(crate) struct ComparisonArguments {
    /// Metric, e.g. `rescuees.total`; can be given several times [default: those that the sweep file names,
    /// or rescuees]
    #[arg(long)]
    pub(crate) metric: Vec<String>,
    /// Compare each policy with this one only; a pair keeps the sign that it has in the folder [default: the
    /// one that the sweep file names; where neither names anything, the first]
    #[arg(long)]
    pub(crate) baseline: Option<String>,
    #[command(flatten)]
    pub(crate) policies: PoliciesArgument,
}

impl ComparisonArguments {
    /// What the user wishes to compare.
    pub(crate) fn wishes(&self) -> Wishes {
        Wishes {
            metrics: self.metric.clone(),
            baseline: self.baseline.clone(),
            policies: self.policies.list(),
            ..Wishes::default()
        }
    }
}

/// The family of comparisons of `compare` and `report`: the same flags, and the same numbers.
#[derive(Debug, Args)]
pub(crate) struct FamilyArguments {
    #[command(flatten)]
    comparison: ComparisonArguments,
    /// The largest difference of a metric that does not matter: says better, worse, equivalent or undecided;
    /// can be given several times
    #[arg(long, value_name = "METRIC=VALUE")]
    margin: Vec<String>,
}

impl FamilyArguments {
    /// The comparisons of a sweep.
    pub(crate) fn asked(&self, experiment: &Experiment) -> Result<Asked, Failure> {
        Asked::of(experiment, &Wishes { margins: self.margin.clone(), ..self.comparison.wishes() })
    }
}
