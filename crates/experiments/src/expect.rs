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
use statistics::comparison::{Pairs, Standing};
use statistics::share::clopper_pearson;
use statistics::stopping::FIRST_LOOK;

use crate::comparison::{Cell, Trials};

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
    /// Both policies are the same in all trials: nothing is tested.
    Same,
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
    /// Why there is no interval of a difference.
    pub needs: Option<String>,
}

/// The looks up to this many trials: 20, 40, 80, ..., and the last.
pub fn looks(most: u32) -> Vec<u32> {
    let doubled = std::iter::successors(Some(FIRST_LOOK), |look| look.checked_mul(2));
    doubled.take_while(|look| *look < most).chain([most]).collect()
}

/// Judges an expectation by the trials of a case. `intervals` is the number of intervals that share the
/// allowed error: looks times cases times expectations. `is_last` says whether this is the last look.
pub fn judge(
    expected: &Expected,
    trials: &Trials,
    case: usize,
    intervals: usize,
    is_last: bool,
) -> Judgement {
    match expected.what {
        Expectation::Share { policy, metric, relation, value: bound, share } => {
            // An undefined metric counts as a trial that does not fulfil the relation.
            let holds = |value: &Option<f64>| value.is_some_and(|value| relation.holds(value, bound));
            let values = trials.in_each(((case, policy), metric));
            let held = values.iter().filter(|value| holds(value)).count();
            judge_share(held, values.len(), share, confidence(expected, intervals), is_last)
        }
        Expectation::Above { metric, policies, .. } | Expectation::Equal { metric, policies, .. } => {
            let cell = |policy: usize| -> Cell { (case, policy) };
            judge_pairs(expected, &trials.pairs(policies.map(|policy| (cell(policy), metric))), intervals)
        }
    }
}

/// The confidence of one of the intervals that share the allowed error.
fn confidence(expected: &Expected, intervals: usize) -> f64 {
    1.0 - (1.0 - expected.confidence) / intervals.max(1) as f64
}

/// Judges an expectation of a difference.
pub fn judge_pairs(expected: &Expected, pairs: &Pairs, intervals: usize) -> Judgement {
    let differences = pairs.differences();
    let (n, confidence) = (differences.len(), confidence(expected, intervals));
    let enough = n >= FIRST_LOOK as usize;
    let interval = enough.then(|| pairs.cautious(confidence)).flatten();
    let is_same = pairs.standing() == Standing::Same;
    let verdict = match (interval, &expected.what) {
        _ if is_same => Verdict::Same,
        (Some([low, _]), Expectation::Above { by, .. }) if low > *by => Verdict::Holds,
        (Some([_, high]), Expectation::Above { by, .. }) if high < *by => Verdict::Fails,
        (Some([low, high]), Expectation::Equal { within, .. }) if -within < low && high < *within => {
            Verdict::Holds
        }
        (Some([low, high]), Expectation::Equal { within, .. }) if low > *within || high < -within => {
            Verdict::Fails
        }
        _ => Verdict::Undecided,
    };
    let needs = || {
        format!(
            "needs {FIRST_LOOK} pairs, and {} differences other than the commonest one (found {})",
            cautious::least_others(confidence),
            cautious::others(&differences)
        )
    };
    let needs = interval.is_none().then(|| if is_same { Standing::Same.to_string() } else { needs() });
    Judgement { verdict, n, observed: pairs.difference(), interval, needs }
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

#[cfg(test)]
mod tests;
