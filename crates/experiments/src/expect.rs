//! Expectations about a sweep's outcome, tested with as few trials as needed.
//!
//! The trials are looked at after 20, 40, 80, ... of them. At each look, an interval of the share or of the
//! mean difference is compared with the expectation. The expectation *holds* if the whole interval agrees
//! with it, and *fails* if no part of the interval does. Otherwise more trials decide. The error that the
//! confidence allows is shared by all intervals of a file: by its planned looks, cases and expectations
//! (Bonferroni). So the probability that any verdict of a file is wrong is at most the stated one.

mod parse;

use serde::Serialize;
use statistics::cautious;
use statistics::share::clopper_pearson;
use statistics::stopping::FIRST_LOOK;

pub use parse::{Bad, expectations, parse};

/// A relation that a sweep's outcome is expected to fulfil.
#[derive(Debug, Clone, PartialEq)]
pub enum Expectation {
    /// A metric of a policy fulfils a relation in a share of the seeds.
    Share {
        /// The policy, by its place.
        policy: usize,
        /// The metric, by its place.
        metric: usize,
        /// How it compares with the value.
        relation: Relation,
        /// The value.
        value: f64,
        /// The least share of the seeds, in (0, 1].
        share: f64,
    },
    /// The mean of one policy exceeds the mean of another by more than a difference.
    Above {
        /// The metric, by its place.
        metric: usize,
        /// The policy that is above, and the other, by their places.
        policies: [usize; 2],
        /// The difference.
        by: f64,
    },
    /// The means of two policies differ by less than a margin.
    Equal {
        /// The metric, by its place.
        metric: usize,
        /// The policies, by their places.
        policies: [usize; 2],
        /// The margin.
        within: f64,
    },
}

/// How a value compares with another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Relation {
    /// `>=`
    AtLeast,
    /// `>`
    Above,
    /// `<=`
    AtMost,
    /// `<`
    Below,
    /// `==`
    Equal,
}

impl Relation {
    fn holds(self, a: f64, b: f64) -> bool {
        match self {
            Self::AtLeast => a >= b,
            Self::Above => a > b,
            Self::AtMost => a <= b,
            Self::Below => a < b,
            Self::Equal => a.total_cmp(&b).is_eq(),
        }
    }
}

impl Expectation {
    /// Whether an interval judges it. A share of all seeds is refuted by one seed, which is never an error.
    pub fn has_interval(&self) -> bool {
        !matches!(self, Self::Share { share, .. } if *share >= 1.0)
    }
}

/// An expectation as written, with its confidence.
#[derive(Debug, Clone, PartialEq)]
pub struct Expected {
    /// The text as written.
    pub text: String,
    /// The parsed expectation.
    pub what: Expectation,
    /// Confidence of the verdict, in (0, 1).
    pub confidence: f64,
}

/// The verdict of trials on an expectation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It holds.
    Holds,
    /// It does not hold.
    Fails,
    /// The trials do not decide.
    Undecided,
}

/// A verdict and its evidence.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Judgement {
    /// The verdict.
    pub verdict: Verdict,
    /// Trials, or pairs of trials.
    pub n: usize,
    /// The observed share (0 to 1) or mean difference.
    pub observed: Option<f64>,
    /// Its interval.
    pub interval: Option<[f64; 2]>,
    /// What an interval needs, if there is none yet.
    pub needs: Option<String>,
}

/// The looks up to this many trials: 20, 40, 80, ..., and the last.
pub fn looks(most: u32) -> Vec<u32> {
    let doubled = std::iter::successors(Some(FIRST_LOOK), |look| look.checked_mul(2));
    doubled.take_while(|look| *look < most).chain([most]).collect()
}

/// Judges an expectation by values of trials. `value(policy, metric)` has one value for each trial, `None`
/// where the metric is undefined. `intervals` is the number of intervals that share the allowed error: looks
/// times cases times expectations. `is_last` says whether this is the last look.
pub fn judge(
    expected: &Expected,
    value: impl Fn(usize, usize) -> Vec<Option<f64>>,
    intervals: usize,
    is_last: bool,
) -> Judgement {
    let confidence = 1.0 - (1.0 - expected.confidence) / intervals.max(1) as f64;
    match expected.what {
        Expectation::Share { policy, metric, relation, value: bound, share } => {
            let values = value(policy, metric);
            // An undefined metric counts as a trial that does not fulfil the relation.
            let held = values.iter().filter(|value| value.is_some_and(|value| relation.holds(value, bound)));
            judge_share(held.count(), values.len(), share, confidence, is_last)
        }
        Expectation::Above { metric, policies, by } => {
            let differences = differences(&value, metric, policies);
            judge_mean(&differences, confidence, |[low, high]| match (low > by, high < by) {
                (true, _) => Verdict::Holds,
                (_, true) => Verdict::Fails,
                _ => Verdict::Undecided,
            })
        }
        Expectation::Equal { metric, policies, within } => {
            let differences = differences(&value, metric, policies);
            judge_mean(&differences, confidence, |[low, high]| {
                if -within < low && high < within {
                    Verdict::Holds
                } else if low > within || high < -within {
                    Verdict::Fails
                } else {
                    Verdict::Undecided
                }
            })
        }
    }
}

fn differences(
    value: &impl Fn(usize, usize) -> Vec<Option<f64>>,
    metric: usize,
    [a, b]: [usize; 2],
) -> Vec<f64> {
    let pairs = value(a, metric).into_iter().zip(value(b, metric));
    pairs.filter_map(|(a, b)| Some(a? - b?)).collect()
}

fn judge_share(held: usize, n: usize, share: f64, confidence: f64, is_last: bool) -> Judgement {
    let observed = (n > 0).then(|| held as f64 / n as f64);
    let interval = clopper_pearson(held, n, confidence);
    let verdict = if share >= 1.0 {
        // A share of 100 %: one seed against it decides. No number of trials can prove it for all possible
        // seeds.
        match (held < n, is_last) {
            (true, _) => Verdict::Fails,
            (false, true) if n > 0 => Verdict::Holds,
            _ => Verdict::Undecided,
        }
    } else {
        match interval {
            Some([low, _]) if low >= share => Verdict::Holds,
            Some([_, high]) if high < share => Verdict::Fails,
            _ => Verdict::Undecided,
        }
    };
    Judgement { verdict, n, observed, interval, needs: None }
}

fn judge_mean(differences: &[f64], confidence: f64, verdict: impl Fn([f64; 2]) -> Verdict) -> Judgement {
    let n = differences.len();
    let observed = (n > 0).then(|| differences.iter().sum::<f64>() / n as f64);
    let enough = n >= FIRST_LOOK as usize;
    let interval = enough.then(|| cautious::interval(differences, confidence)).flatten();
    let needs = interval.is_none().then(|| {
        format!(
            "needs {FIRST_LOOK} pairs, and {} differences other than the commonest one (found {})",
            cautious::least_others(confidence),
            cautious::others(differences)
        )
    });
    Judgement { verdict: interval.map_or(Verdict::Undecided, verdict), n, observed, interval, needs }
}

#[cfg(test)]
mod tests;
