//! `--precision`: adds paired trials until a difference is known with enough precision.
//!
//! The rule looks at the half width of the 95 % paired t interval. The first look is after [`FIRST_LOOK`]
//! pairs or the sweep's trials, whichever is more. Each later look is after a quarter more pairs. The rule
//! stops when every case of the sweep has reached the bound. It looks only at the width, never at the
//! difference itself or its p, so that stopping does not favour any finding. `docs/experiments.md` gives
//! its effect on the interval's coverage.

use experiments::Failure;
use experiments::comparison::{Trials, short};
use experiments::experiment::Experiment;
use experiments::sweep::folder::Folder;
use statistics::paired::t_half_width;
use statistics::stopping::{FIRST_LOOK, next_look};

/// The stopping rule.
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
        let metric = experiment.metrics.named(metric.trim());
        let metric = metric.map_err(Failure::input_at("--precision"))?;
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

    /// Number of pairs at the first look.
    pub(super) fn first_look(trials: u32, most: u32) -> u32 {
        trials.max(FIRST_LOOK).min(most.max(trials))
    }

    /// Number of pairs at the next look; `None` if no further look is needed or allowed.
    pub(super) fn next_look(&self, folder: &Folder, most: u32) -> Option<u32> {
        let trials = folder.experiment().trials;
        let is_reached = self.state(folder).is_some_and(|state| state.half_width <= self.bound);
        (!is_reached && trials < most).then(|| next_look(trials).min(most))
    }

    /// The state of the rule; `None` if a case has too few pairs, or pairs without any spread.
    fn state(&self, folder: &Folder) -> Option<State> {
        let mut state = State { half_width: 0.0, pairs: usize::MAX };
        for case in 0..folder.experiment().cases.len() {
            let pair = self.policies.map(|policy| ((case, policy), self.metric));
            let differences = Trials::of(folder, case).pairs(pair).differences();
            let half_width = t_half_width(&differences).filter(|half| *half > 0.0)?;
            let enough = differences.len() >= FIRST_LOOK.min(folder.experiment().trials) as usize;
            state.half_width = state.half_width.max(half_width);
            state.pairs = state.pairs.min(differences.len());
            if !enough {
                return None;
            }
        }
        Some(state)
    }

    /// The result of the rule, in words.
    pub(super) fn verdict(&self, folder: &Folder) -> String {
        let (metric, [a, b], bound) =
            (&folder.experiment().metrics[self.metric].name, &self.labels, short(self.bound));
        match self.state(folder) {
            Some(State { half_width, pairs }) if half_width <= self.bound => format!(
                "precision reached: the 95 % interval of {metric}, {a} less {b}, is its mean ± {} or \
                 narrower ({pairs} pairs, bound {bound})",
                short(half_width)
            ),
            Some(State { half_width, pairs }) => format!(
                "precision NOT reached: the 95 % interval of {metric}, {a} less {b}, is its mean ± {} after \
                 {pairs} pairs, bound {bound}; more trials (--max-trials) go on",
                short(half_width)
            ),
            None => format!(
                "precision NOT reached: there are too few pairs in which {metric} is defined for both, or \
                 they do not differ among themselves"
            ),
        }
    }
}

/// The state of the rule.
struct State {
    /// The greatest half width among all cases.
    half_width: f64,
    /// The least number of pairs among all cases.
    pairs: usize,
}
