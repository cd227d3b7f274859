//! The cells of a sweep of lies: which cases have which lie and how many liars.

use std::collections::BTreeMap;

use rne_core::arrow::Written;

use crate::experiment::{Experiment, PolicySpec};
use crate::{Failure, refuse};

/// Confidence of every interval and of every statement about a breakdown.
pub(super) const CONFIDENCE: f64 = 0.95;

/// The policy whose trials are the draw where the sweep file names no baseline.
const DRAW: &str = "RANDOM";

/// The policy that hears nothing of what robots say.
pub(super) const DEAF: &str = "DIS";

/// A difference of paired trials.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Its mean; `None` without pairs.
    pub mean: Option<f64>,
    /// Its interval; `None` where too few pairs differ.
    pub interval: Option<[f64; 2]>,
}

/// A lie, with the cases of each number of liars.
pub(super) struct Lie {
    pub(super) name: String,
    pub(super) cases: Vec<usize>,
}

/// The estimator behind a policy that hears nothing of what robots say: it changes no decision, unless it
/// leaves robots at home.
pub(super) fn deaf_guide(policy: &PolicySpec) -> Option<String> {
    let written = policy.plain();
    match Written::of(&written) {
        Written { rule: DEAF, guide } if !policy.made().it.leaves_idle() => guide.map(str::to_owned),
        _ => None,
    }
}

/// The place of the draw among the policies.
pub(super) fn draw(experiment: &Experiment) -> Result<usize, Failure> {
    let draw = experiment.plan.baseline.as_deref().unwrap_or(DRAW);
    match experiment.policies.iter().position(|policy| policy.label == draw) {
        Some(place) => Ok(place),
        None => refuse!("policies must have {draw}, the fair draw"),
    }
}

/// The numbers of liars, and for each lie its cases in the order of the numbers.
pub(super) fn lies(experiment: &Experiment) -> Result<(Vec<u32>, Vec<Lie>), Failure> {
    let counts = |values: &[String]| values.iter().map(|value| count(value)).collect::<Option<Vec<u32>>>();
    let mut axes = experiment.axes.iter().enumerate();
    let Some((axis, counts)) = axes.find_map(|(place, axis)| Some((place, counts(&axis.values)?))) else {
        refuse!("must have an axis of who lies, such as \"deceit[0].who\": [Count(0), Count(1), Count(2)]");
    };
    if !counts.contains(&0) {
        refuse!("{}: must have Count(0), to compare with honest robots", experiment.axes[axis].path);
    }
    let mut order: Vec<usize> = (0..counts.len()).collect();
    order.sort_by_key(|place| counts[*place]);
    let mut lies: BTreeMap<usize, Lie> = BTreeMap::new();
    let mut places: BTreeMap<String, usize> = BTreeMap::new();
    for (number, case) in experiment.cases.iter().enumerate() {
        let others = case.values.iter().enumerate().filter(|(place, _)| *place != axis);
        let name = others.map(|(_, value)| value.as_str()).collect::<Vec<_>>().join(", ");
        let next = places.len();
        let place = *places.entry(name.clone()).or_insert(next);
        let lie = lies.entry(place).or_insert_with(|| Lie { name, cases: vec![0; counts.len()] });
        let of = experiment.axes[axis].values.iter().position(|value| *value == case.values[axis]);
        if let Some(at) = of.and_then(|of| order.iter().position(|place| *place == of)) {
            lie.cases[at] = number;
        }
    }
    Ok((order.into_iter().map(|place| counts[place]).collect(), lies.into_values().collect()))
}

/// The number in `Count(3)`.
fn count(value: &str) -> Option<u32> {
    value.trim().strip_prefix("Count(")?.strip_suffix(')')?.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_liars_are_read() {
        assert_eq!(["Count(0)", " Count( 12 )", "Share(0.5)"].map(count), [Some(0), Some(12), None]);
    }
}
