//! What the trials of a sweep of lies show.

use statistics::breakdown::Breakdown;
use statistics::comparison::Pairs;
use teaming::arrow::Written;

use super::cells::{CONFIDENCE, Difference, Lie, deaf_guide, draw, lies};
use crate::Failure;
use crate::comparison::Trials;
use crate::experiment::{Experiment, PolicySpec};
use crate::sweep::folder::Folder;

/// Metrics of how well an estimator judges, in the order of the table.
pub const ACCURACY: [&str; 5] = ["level_mae", "tau_b", "trust_auc", "trust_brier", "rounds_to_detect"];

/// A policy under one lie.
#[derive(Debug, Clone, PartialEq)]
pub struct Borne {
    /// Label of the policy.
    pub policy: String,
    /// The lie: the values of the other axes.
    pub lie: String,
    /// The mean of the metric for each number of liars.
    pub means: Vec<Option<f64>>,
    /// The mean of its difference from the draw, likewise; only trials count that have one for each number.
    pub differences: Vec<Option<f64>>,
    /// How many liars it bears.
    pub breakdown: Breakdown,
}

/// What a policy behind an estimator has or lacks beside the same policy without it, where nobody lies.
#[derive(Debug, Clone, PartialEq)]
pub struct Price {
    /// Label of the policy with its estimator.
    pub policy: String,
    /// Label of the policy without.
    pub rule: String,
    /// The lie, or the world; lies with the same price as an earlier one are left out, as all are where
    /// nobody lies.
    pub lie: String,
    /// The first minus the second.
    pub difference: Difference,
}

/// How well an estimator judges under one lie, by the policy whose questions do not depend on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgement {
    /// The estimator.
    pub guide: String,
    /// The lie.
    pub lie: String,
    /// Number of liars.
    pub liars: u32,
    /// Means of [`ACCURACY`] over trials.
    pub values: Vec<Option<f64>>,
}

/// What lies cost.
#[derive(Debug, Clone, PartialEq)]
pub struct Deceit {
    /// Name of the metric.
    pub metric: String,
    /// The largest difference that does not matter, if the sweep file names one.
    pub margin: Option<f64>,
    /// Label of the draw.
    pub draw: String,
    /// Numbers of liars.
    pub counts: Vec<u32>,
    /// Each policy under each lie, but the draw and those of which only the estimator is of interest.
    pub borne: Vec<Borne>,
    /// The price of each estimator.
    pub prices: Vec<Price>,
    /// How well estimators judge, from trials of DIS, which hears nothing that robots say: all estimators see
    /// the same evidence.
    pub judgements: Vec<Judgement>,
}

/// A sweep as rows of numbers of liars.
struct Rows<'f> {
    folder: &'f Folder,
    metric: usize,
    counts: Vec<u32>,
    /// For each lie, the cases with each number of liars.
    lies: Vec<Lie>,
}

impl Deceit {
    /// Whether a sweep can be looked at in this way.
    ///
    /// # Errors
    /// It has no axis of numbers of liars, or no draw.
    pub fn check(experiment: &Experiment) -> Result<(), Failure> {
        lies(experiment)?;
        draw(experiment)?;
        Ok(())
    }

    /// What the trials of a sweep show.
    ///
    /// # Errors
    /// The sweep has no axis of numbers of liars, or no draw.
    pub fn of(folder: &Folder) -> Result<Self, Failure> {
        let experiment = folder.experiment();
        let (counts, lies) = lies(experiment)?;
        let metric = *experiment.metrics.chosen(&experiment.plan.primary)?.first().unwrap_or(&0);
        let rows = Rows { folder, metric, counts, lies };
        let of_draw = draw(experiment)?;
        let name = &experiment.metrics[metric].name;
        let mut margin = None;
        for (of, value) in &experiment.plan.margins {
            margin = margin.or((experiment.metrics.named(of)? == metric).then_some(*value));
        }
        let hears = |policy: &usize| deaf_guide(&experiment.policies[*policy]).is_none();
        let others = (0..experiment.policies.len()).filter(|policy| *policy != of_draw).filter(hears);
        let pairs = others.flat_map(|policy| rows.lies.iter().map(move |lie| (policy, lie)));
        Ok(Self {
            metric: name.clone(),
            margin,
            borne: pairs.map(|(policy, lie)| rows.borne(policy, of_draw, lie, margin)).collect(),
            prices: rows.prices(),
            judgements: rows.judgements()?,
            draw: rows.label(of_draw).to_owned(),
            counts: rows.counts,
        })
    }
}

impl Rows<'_> {
    fn label(&self, policy: usize) -> &str {
        &self.folder.experiment().policies[policy].label
    }

    fn mean(&self, case: usize, policy: usize, metric: usize) -> Option<f64> {
        Trials::of(self.folder, case).moments(((case, policy), metric)).mean
    }

    fn borne(&self, policy: usize, draw: usize, lie: &Lie, margin: Option<f64>) -> Borne {
        let pair = |case: &usize| [policy, draw].map(|policy| ((*case, policy), self.metric));
        let pairs: Vec<_> = lie.cases.iter().map(pair).collect();
        let found = Trials::of(self.folder, lie.cases[0]).joint(&pairs);
        let differences: Vec<Vec<f64>> = found.iter().map(Pairs::differences).collect();
        let direction = self.folder.experiment().metrics[self.metric].direction;
        let mean = |case: &usize| self.mean(*case, policy, self.metric);
        Borne {
            policy: self.label(policy).to_owned(),
            lie: lie.name.clone(),
            means: lie.cases.iter().map(mean).collect(),
            differences: found.iter().map(Pairs::difference).collect(),
            breakdown: Breakdown::of(&differences, margin.unwrap_or(0.0), CONFIDENCE, direction),
        }
    }

    /// Each policy behind an estimator against the same one without, among honest robots.
    fn prices(&self) -> Vec<Price> {
        let policies = 0..self.folder.experiment().policies.len();
        let pairs = policies.filter_map(|policy| Some((policy, self.rule_of(policy)?)));
        let mut prices: Vec<Price> = Vec::new();
        for (policy, rule) in pairs {
            for lie in &self.lies {
                let price = self.price(policy, rule, lie);
                let is_known =
                    |known: &Price| known.policy == price.policy && known.difference == price.difference;
                if !prices.iter().any(is_known) {
                    prices.push(price);
                }
            }
        }
        prices
    }

    /// The same policy without its estimator, if the sweep has it.
    fn rule_of(&self, policy: usize) -> Option<usize> {
        let policies = &self.folder.experiment().policies;
        let written = policies[policy].plain();
        let parts = Written::of(&written);
        parts.guide?;
        let is_rule = |other: &PolicySpec| {
            let (written, with) = (other.plain(), parts.protocol);
            Written::of(&written) == Written { rule: parts.rule, guide: None, protocol: with }
        };
        policies.iter().position(is_rule)
    }

    fn price(&self, policy: usize, rule: usize, lie: &Lie) -> Price {
        let honest = lie.cases[0];
        let pair = [policy, rule].map(|policy| ((honest, policy), self.metric));
        let difference = Difference::of(&Trials::of(self.folder, honest).pairs(pair));
        let [policy, rule] = [policy, rule].map(|it| self.label(it).to_owned());
        Price { policy, rule, lie: lie.name.clone(), difference }
    }

    fn judgements(&self) -> Result<Vec<Judgement>, Failure> {
        let experiment = self.folder.experiment();
        let places: Vec<usize> =
            ACCURACY.iter().map(|name| experiment.metrics.named(name)).collect::<Result<_, _>>()?;
        let mut judgements = Vec::new();
        for (policy, spec) in experiment.policies.iter().enumerate() {
            let Some(guide) = deaf_guide(spec) else { continue };
            for lie in &self.lies {
                for (case, liars) in lie.cases.iter().zip(&self.counts) {
                    let (guide, lie) = (guide.clone(), lie.name.clone());
                    let values = places.iter().map(|metric| self.mean(*case, policy, *metric)).collect();
                    judgements.push(Judgement { guide, lie, liars: *liars, values });
                }
            }
        }
        Ok(judgements)
    }
}
