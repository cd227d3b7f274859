//! Calibration: the search for free parameters of a scenario with which the distance baseline reproduces
//! recorded trials of it.
//!
//! Only [`POLICY`] can be run here. The performance of other policies in the calibrated world is a result,
//! so that no fit may use it. The search is by least squares without derivatives, over a box. It is
//! deterministic. An interrupted search is repeated from its start, with the evaluations in the log instead
//! of new trials.

mod choice;
mod fit;
mod identify;
mod least_squares;
mod log;
mod target;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};

use experiments::comparison::short;
use experiments::experiment::PolicySpec;
use experiments::explore::{Parameter, PointError, WORST, scenario_with};
use experiments::run::{Fault, TrialSetup, run_trial};
use experiments::{Failure, panic_message, refuse};
use rayon::prelude::*;
use ron_tree::{Node, Problem, edited};
use scenario::Scenario;
use serde::{Deserialize, Serialize};
use teaming::Registry;

pub use choice::{Candidate, Judged, NOT_TOLD_APART, judge};
pub use fit::{Fit, write_fit};
pub use identify::Identified;
use least_squares::LeastSquares;
pub use log::{CALIBRATED, Log, best, open};
pub use target::{Quantity, Spread, Target};

/// The only policy that is calibrated.
pub const POLICY: &str = "DIS";

/// Suffix of a calibrated scenario's name.
const SUFFIX: &str = "-fitted";

/// Start of a calibrated scenario's first line.
const ORIGIN_LINE: &str = "// Fitted by usar yang2021 calibrate";

/// Edge penalty of a value at the very end of its range: the same as for a mean that is off by two standard
/// errors.
const EDGE: f64 = 4.0;

/// A calibration: a scenario with free parameters, and its target.
pub struct Calibration {
    /// The scenario to start from, as text in which each free field is written.
    pub text: String,
    /// The scenario, checked.
    pub base: Scenario,
    /// The policy that decides in it: see [`the_policy`].
    pub policy: PolicySpec,
    /// The free parameters.
    pub free: Vec<Parameter>,
    /// The target of the fit.
    pub target: Target,
    /// Number of trials of an evaluation.
    pub trials: u32,
    /// Seed of the first trial.
    pub first_seed: u64,
    /// Distance of the first candidates from the start, as a share of each range.
    pub first_step: f64,
}

/// One candidate and its evaluation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Evaluation {
    /// A value for each free parameter.
    pub values: Vec<f64>,
    /// Distance from the target, including the edge penalty.
    pub misfit: f64,
    /// Means and spreads of the target's quantities; empty for a candidate that cannot be run.
    pub spreads: Vec<Spread>,
    /// Why it cannot be run.
    pub failure: Option<String>,
}

impl Calibration {
    /// The scenario with these values.
    ///
    /// # Errors
    /// A value breaks a rule.
    pub fn scenario(&self, values: &[f64]) -> Result<Scenario, PointError> {
        scenario_with(&self.base, &self.free, values)
    }

    /// The text of the scenario with these values in their places, and a name with a suffix. Everything
    /// else, including comments, stays as it is.
    ///
    /// # Errors
    /// None: each free field is written in the text.
    pub(crate) fn text_with(&self, values: &[f64]) -> Result<String, Box<Problem>> {
        let pairs = self.free.iter().zip(values).flat_map(|(free, value)| free.settings(*value));
        let mut settings: Vec<_> = pairs.map(|(path, value)| (path.to_owned(), value)).collect();
        if !self.base.name.ends_with(SUFFIX) {
            settings.push(("name".to_owned(), format!("{:?}", format!("{}{SUFFIX}", self.base.name))));
        }
        edited(&self.text, &settings)
    }

    /// The same text with a first line that describes the fit. No other policy can run in this scenario.
    ///
    /// # Errors
    /// None: each free field is written in the text.
    pub fn fitted_text(&self, evaluation: &Evaluation) -> Result<String, Box<Problem>> {
        let text = self.text_with(&evaluation.values)?;
        let text = match text.split_once('\n') {
            Some((first, rest)) if first.starts_with(ORIGIN_LINE) => rest,
            _ => &text,
        };
        let text = candidate(text);
        let names: Vec<&str> = self.free.iter().map(|free| free.name.as_str()).collect();
        Ok(format!(
            "{ORIGIN_LINE} (misfit {} over {} trials of {POLICY}), whatever comments below say of them: \
             {}\n{text}",
            short(evaluation.misfit),
            self.trials,
            names.join(", "),
        ))
    }

    /// The start of the search: the values of the scenario, or the nearest values in their ranges.
    ///
    /// # Errors
    /// A field is not a number.
    pub fn start(&self) -> Result<Vec<f64>, Failure> {
        let ends = self.free.iter().map(Parameter::ends);
        Ok(self.present()?.into_iter().zip(ends).map(|(value, [low, high])| value.clamp(low, high)).collect())
    }

    /// The scenario's own values of the free parameters.
    ///
    /// # Errors
    /// A field is not a number.
    pub fn present(&self) -> Result<Vec<f64>, Failure> {
        let tree = Node::parse(&self.text).map_err(Failure::run)?;
        let present = |free: &Parameter| free.present(&tree);
        let present = self.free.iter().map(present).collect::<Result<Vec<f64>, _>>();
        present.map_err(Failure::input_at("--over"))
    }

    /// Checks that no field is set twice, that no parameter decides the duration of a trial, and that both
    /// ends of each range can be run with the other fields unchanged.
    ///
    /// # Errors
    /// One of these conditions is violated.
    pub fn check(&self) -> Result<(), Failure> {
        self.text_with(&self.present()?).map_err(Failure::input_at("--over"))?;
        for free in &self.free {
            if free.is_of("duration_s") {
                refuse!("--over: duration_s: is that of the recorded trials");
            }
            for end in free.ends() {
                scenario_with(&self.base, std::slice::from_ref(free), &[end]).map_err(|error| {
                    let is_refused =
                        matches!(&error, PointError::Rule(problem) if problem.rule.contains("whole number"));
                    let whole = free.whole_numbers(&self.base).filter(|_| is_refused);
                    Failure::input_at("--over")(whole.unwrap_or_else(|| error.to_string()))
                })?;
            }
        }
        Ok(())
    }

    /// The quantities of trials with these seeds, each a list over the trials. `None` if `stop` was set.
    ///
    /// # Errors
    /// The candidate cannot be run.
    pub fn measure(
        &self,
        values: &[f64],
        seeds: impl IntoParallelIterator<Item = u64>,
        stop: &AtomicBool,
    ) -> Result<Option<Vec<Vec<f64>>>, Failure> {
        let scenario = self.scenario(values).map_err(Failure::run)?;
        let trial = |seed| {
            let setup = TrialSetup { scenario: &scenario, seed, is_checked: false };
            let run = AssertUnwindSafe(|| {
                let mut session = self.policy.made().open().map_err(|error| Fault::of_policy(&error))?;
                run_trial(&setup, &mut *session, stop)
            });
            let result = catch_unwind(run)
                .map_err(|panic| Failure::run(format!("internal error: {}", panic_message(&*panic))))?;
            result.map_err(|fault| Failure::run(fault.reason))
        };
        let rows: Vec<Result<Vec<f64>, Failure>> =
            seeds.into_par_iter().map(|seed| self.target.measure(&trial(seed)?.record)).collect();
        if stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        // The first failure in the order of the seeds, independent of the number of threads.
        let rows = rows.into_iter().collect::<Result<Vec<Vec<f64>>, Failure>>()?;
        Ok(Some((0..self.target.spreads.len()).map(|q| rows.iter().map(|row| row[q]).collect()).collect()))
    }

    /// Edge penalty of these values: the sum over all values near the ends of their ranges.
    pub fn edge_penalty(&self, values: &[f64]) -> f64 {
        self.free.iter().zip(values).map(|(free, value)| edge_penalty(free, *value)).sum()
    }

    fn evaluate(&self, values: Vec<f64>, stop: &AtomicBool) -> Option<Evaluation> {
        let seeds = (0..self.trials).into_par_iter().map(|trial| self.first_seed + u64::from(trial));
        match self.measure(&values, seeds, stop) {
            Ok(None) => None,
            Ok(Some(quantities)) => {
                let spreads: Vec<Spread> =
                    quantities.iter().filter_map(|values| Spread::of(values)).collect();
                let misfit = self.target.misfit(&spreads, self.trials as usize) + self.edge_penalty(&values);
                Some(Evaluation { misfit, values, spreads, failure: None })
            }
            Err(error) => {
                let failure = Some(error.to_string());
                Some(Evaluation { values, misfit: WORST, spreads: Vec::new(), failure })
            }
        }
    }

    /// Evaluates the start and searches from there, `evaluations` candidates in all. Returns false if
    /// `stop` interrupted it. `done` receives the number of evaluations so far and the least misfit.
    ///
    /// # Errors
    /// The disk does not take the log.
    pub fn search(
        &self,
        evaluations: usize,
        log: &mut Log,
        stop: &AtomicBool,
        mut done: impl FnMut(usize, f64),
    ) -> Result<bool, Failure> {
        let start = self.start()?;
        let places = self.free.iter().zip(&start).map(|(free, value)| free.place_of(*value)).collect();
        let mut search = LeastSquares::new(places, self.first_step);
        let mut least = WORST;
        for asked in 1..=evaluations {
            let place = search.propose();
            let there = || self.free.iter().zip(&place).map(|(free, x)| free.value(*x)).collect();
            let values = if asked == 1 { start.clone() } else { there() };
            if !log.entries.iter().any(|evaluation| evaluation.values == values) {
                let Some(evaluation) = self.evaluate(values.clone(), stop) else { return Ok(false) };
                log.add(vec![evaluation])?;
            }
            if let Some(evaluation) = log.entries.iter().find(|evaluation| evaluation.values == values) {
                least = least.min(evaluation.misfit);
                if evaluation.failure.is_none() {
                    search.tell(&place, self.residuals(evaluation));
                }
            }
            done(asked, least);
        }
        Ok(true)
    }

    /// The residuals that the search minimises; their squares add up to the misfit.
    fn residuals(&self, evaluation: &Evaluation) -> Vec<f64> {
        let of_data = self.target.residuals(&evaluation.spreads, self.trials as usize);
        let edges = self.free.iter().zip(&evaluation.values);
        of_data.into_iter().chain(edges.map(|(free, value)| edge_penalty(free, *value).sqrt())).collect()
    }
}

/// Edge penalty of a value: `EDGE` at the very end of its range, 0 from a twentieth of the range inwards,
/// and quadratic in between. A value at an end means that the range decides instead of the data.
fn edge_penalty(free: &Parameter, value: f64) -> f64 {
    let place = free.place_of(value);
    let from_end = place.min(1.0 - place).max(0.0);
    EDGE * (1.0 - from_end / 0.05).max(0.0).powi(2)
}

/// The text of a scenario that allows only the calibrated policy.
fn candidate(text: &str) -> String {
    let tree = Node::parse(text).ok().filter(|tree| tree.get("only_policy").is_none());
    let end = tree.and_then(|tree| Some(tree.get("name")?.bytes().end));
    end.map_or_else(
        || text.to_owned(),
        |end| format!("{}, only_policy: \"{POLICY}\"{}", &text[..end], &text[end..]),
    )
}

/// The only policy that is calibrated, from a registry.
///
/// # Errors
/// The registry lacks it.
pub fn the_policy(registry: &Registry) -> Result<PolicySpec, Failure> {
    PolicySpec::parse(POLICY, registry).map_err(Failure::input)
}
