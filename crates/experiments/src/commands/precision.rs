//! `--precision`: add paired trials until a difference is known well enough.
//!
//! The rule looks at the half width of the 95 % paired t interval, after [`FIRST_LOOK`] pairs or the sweep's trials, whichever is more, and
//! then each time the number of pairs has grown by a quarter; it stops when the bound is reached in every case of the sweep. It looks at the
//! width alone, never at the difference itself or its p, so stopping does not favour any finding; `docs/experiments.md` says what it does
//! to the interval's coverage.

use crate::comparison::{Pairs, short};
use crate::experiment::Experiment;
use crate::failure::Failure;
use crate::metric::{METRICS, metric_named};
use crate::stats::paired::t_half_width;
use crate::stats::stopping::{FIRST_LOOK, next_look};
use crate::sweep::folder::Folder;

/// The rule.
pub(super) struct Precision {
    metric: usize,
    policies: [usize; 2],
    labels: [String; 2],
    bound: f64,
}

impl Precision {
    /// Reads `METRIC: A-B: BOUND`.
    pub(super) fn parse(text: &str, experiment: &Experiment) -> Result<Self, Failure> {
        let bad = |reason: &str| Failure::input(format!("--precision: {reason}, found {text:?}"));
        let form = "must be 'METRIC: A-B: BOUND'";
        let (metric, rest) = text.split_once(':').ok_or_else(|| bad(form))?;
        let (pair, bound) = rest.rsplit_once(':').ok_or_else(|| bad(form))?;
        let metric =
            metric_named(metric.trim()).map_err(|error| Failure::input(format!("--precision: {error}")))?;
        let bound: f64 = bound.trim().parse().map_err(|_| bad("the bound must be a number"))?;
        if !(bound.is_finite() && bound > 0.0) {
            return Err(bad("the bound must be a number above 0"));
        }
        let place = |label: &str| experiment.policies.iter().position(|policy| policy.label == label.trim());
        let splits = pair.match_indices('-').map(|(at, _)| [&pair[..at], &pair[at + 1..]]);
        let known = splits.filter_map(|[a, b]| Some([place(a)?, place(b)?])).find(|[a, b]| a != b);
        let policies = known.ok_or_else(|| bad("A and B must be two policies of the sweep"))?;
        let labels = policies.map(|policy| experiment.policies[policy].label.clone());
        Ok(Self { metric, policies, labels, bound })
    }

    /// Pairs at the first look.
    pub(super) fn first_look(trials: u32, most: u32) -> u32 {
        trials.max(FIRST_LOOK).min(most.max(trials))
    }

    /// Pairs at the next look, if there is to be one.
    pub(super) fn next_look(&self, folder: &Folder, most: u32) -> Option<u32> {
        let trials = folder.experiment().trials;
        let is_reached = self.half_width(folder).is_some_and(|half| half <= self.bound);
        (!is_reached && trials < most).then(|| next_look(trials).min(most))
    }

    /// The greatest half width over all cases; `None` where one has too few pairs.
    fn half_width(&self, folder: &Folder) -> Option<f64> {
        let cases = 0..folder.experiment().cases.len();
        let half = |case| t_half_width(&Pairs::of(folder, case, self.metric, self.policies).differences());
        cases.map(half).try_fold(0.0, |most: f64, half| Some(most.max(half?)))
    }

    /// What came of it, in words.
    pub(super) fn verdict(&self, folder: &Folder) -> String {
        let (metric, [a, b], bound) = (METRICS[self.metric].name, &self.labels, short(self.bound));
        let trials = folder.experiment().trials;
        match self.half_width(folder) {
            Some(half) if half <= self.bound => format!(
                "precision reached: the 95 % interval of {metric}, {a} less {b}, is its mean ± {} or narrower ({trials} pairs, bound {bound})",
                short(half)
            ),
            Some(half) => format!(
                "precision NOT reached: the 95 % interval of {metric}, {a} less {b}, is its mean ± {} after {trials} pairs, bound {bound}; \
                 a larger --max-trials goes on",
                short(half)
            ),
            None => format!("precision NOT reached: there are too few pairs in which {metric} is defined"),
        }
    }
}
