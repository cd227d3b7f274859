//! The family of comparisons that a command makes.

use clap::Args;
use experiments::Failure;
use experiments::comparison::{Asked, Wishes};
use experiments::experiment::{Experiment, split_list};

/// What is compared: `compare` and `report` take the same flags, and say the same.
#[derive(Debug, Args)]
pub(crate) struct FamilyArguments {
    /// Metric to compare, or `all`; can be given several times [default: those that the sweep file names, or
    /// rescuees]
    #[arg(long)]
    metric: Vec<String>,
    /// Compare each policy with this one only [default: the one that the sweep file names; where neither
    /// names anything, the first]
    #[arg(long)]
    baseline: Option<String>,
    /// The largest difference of a metric that does not matter: says better, worse, equivalent or undecided;
    /// can be given several times
    #[arg(long, value_name = "METRIC=VALUE")]
    margin: Vec<String>,
    /// Compare these policies only, by their labels, separated by commas
    #[arg(long)]
    policies: Option<String>,
}

impl FamilyArguments {
    /// The comparisons of a sweep.
    pub(super) fn asked(&self, experiment: &Experiment) -> Result<Asked, Failure> {
        let policies = self.policies.as_deref().map(split_list);
        let wishes = Wishes {
            metrics: self.metric.clone(),
            baseline: self.baseline.clone(),
            margins: self.margin.clone(),
            policies: policies.map(|labels| labels.into_iter().map(str::to_owned).collect()),
        };
        Asked::of(experiment, &wishes)
    }
}
