//! The cells of a sweep of lies: which cases have which lie and how many liars.

use serde::Serialize;
use statistics::comparison::Pairs;
use teaming::arrow::Written;

use crate::experiment::{Experiment, PolicySpec};
use crate::{Failure, refuse};

/// Confidence of every interval and of every statement about a breakdown.
pub(super) const CONFIDENCE: f64 = 0.95;

/// The policy whose trials are the draw where the sweep file names no baseline.
const DRAW: &str = "RANDOM";

/// The policy that hears nothing of what robots say.
pub(super) const DEAF: &str = "DIS";

/// A difference of paired trials.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Difference {
    /// Its mean; `None` without pairs.
    pub mean: Option<f64>,
    /// Its interval; `None` where too few pairs differ.
    pub interval: Option<[f64; 2]>,
}

impl Difference {
    /// The difference of these pairs.
    pub(super) fn of(pairs: &Pairs) -> Self {
        Self { mean: pairs.difference(), interval: pairs.cautious(CONFIDENCE) }
    }
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
        Written { rule: DEAF, guide, protocol: None } if !policy.made().it.leaves_idle() => {
            guide.map(str::to_owned)
        }
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

/// The numbers of liars, ascending, and for each lie its cases in the order of the numbers.
pub(super) fn lies(experiment: &Experiment) -> Result<(Vec<u32>, Vec<Lie>), Failure> {
    let Some(who) = experiment.axes.iter().position(|axis| counts(&axis.values).is_some()) else {
        refuse!("must have an axis of who lies, such as \"deceit[0].who\": [Count(0), Count(1), Count(2)]");
    };
    let mut numbers = counts(&experiment.axes[who].values).unwrap_or_default();
    numbers.sort_unstable();
    if numbers.first() != Some(&0) {
        refuse!("{}: must have Count(0), to compare with honest robots", experiment.axes[who].path);
    }
    let mut lies: Vec<Lie> = Vec::new();
    for (number, case) in experiment.cases.iter().enumerate() {
        let others = case.values.iter().enumerate().filter(|(place, _)| *place != who);
        let name = others.map(|(_, value)| value.as_str()).collect::<Vec<_>>().join(", ");
        let place = lies.iter().position(|lie| lie.name == name).unwrap_or(lies.len());
        if place == lies.len() {
            lies.push(Lie { name, cases: vec![0; numbers.len()] });
        }
        let liars = count(&case.values[who]);
        if let Some(at) = numbers.iter().position(|number| Some(*number) == liars) {
            lies[place].cases[at] = number;
        }
    }
    Ok((numbers, lies))
}

/// The numbers in `Count(0)`, `Count(3)`; `None` if a value is another.
fn counts(values: &[String]) -> Option<Vec<u32>> {
    values.iter().map(|value| count(value)).collect()
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
