//! A scenario with parameters that vary within ranges, and the outcomes at a point.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use ron_tree::Problem;
use scenario::{Scenario, ScenarioFile};
use serde::{Deserialize, Serialize};
use store::{Failure, refuse};
use thiserror::Error;

use super::Parameter;
use crate::comparison::{Choice, Trials, policy_pairs};
use crate::experiment::Experiment;
use crate::panics::panic_message;
use crate::run::{Fault, Sessions, SharedTrials, TrialSetup};
use crate::sweep::folder::{Measured, Results};

/// An outcome: a policy's mean of a metric, or the mean of the paired differences of two policies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outcome {
    /// Place of the metric.
    #[serde(skip)]
    pub metric: usize,
    /// Place of the policy.
    #[serde(skip)]
    pub policy: usize,
    /// Place of the policy that is subtracted, for a difference.
    #[serde(skip)]
    pub less: Option<usize>,
    /// The policy, or both policies: `RNE`, `RNE - DIS`.
    pub who: String,
    /// Name of the metric.
    pub what: String,
}

impl Outcome {
    /// A name for a column: `RNE - DIS: rescuees.total`.
    pub fn name(&self) -> String {
        format!("{}: {}", self.who, self.what)
    }
}

/// The parameters of a scenario, and the outcomes.
pub struct Space {
    /// The scenario and the policies; it has one case.
    pub experiment: Experiment,
    /// The parameters.
    pub free: Vec<Parameter>,
    /// The outcomes.
    pub outcomes: Vec<Outcome>,
}

/// The value of each outcome at a point, `None` where it is undefined; or the reason why the point failed.
pub type Values = Result<Vec<Option<f64>>, PointError>;

/// Why a point has no scenario or no outcome.
#[derive(Debug, Clone, PartialEq, Eq, Error, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub enum PointError {
    /// A field does not take its value, or the values together break a rule.
    #[error(transparent)]
    Rule(#[from] Box<Problem>),
    /// A trial failed.
    #[error("{policy}, seed {seed}: {reason}")]
    Trial {
        /// Label of the policy.
        policy: String,
        /// Seed of the trial.
        seed: u64,
        /// Why it failed.
        reason: String,
    },
    /// The metric is defined in no trial.
    #[error("the metric is defined in no trial")]
    Undefined,
    /// An earlier run of the command found the point to fail.
    #[error("{reason}")]
    Logged {
        /// The reason in the log.
        reason: String,
    },
}

impl From<String> for PointError {
    fn from(reason: String) -> Self {
        Self::Logged { reason }
    }
}

impl From<PointError> for String {
    fn from(error: PointError) -> Self {
        error.to_string()
    }
}

impl From<Vec<Problem>> for PointError {
    /// The first problem.
    fn from(mut problems: Vec<Problem>) -> Self {
        Self::Rule(Box::new(problems.swap_remove(0)))
    }
}

/// A scenario in which these parameters have other values.
///
/// # Errors
/// A field does not take its value, or the values together break a rule.
pub fn scenario_with(base: &Scenario, free: &[Parameter], values: &[f64]) -> Result<Scenario, PointError> {
    let mut file: ScenarioFile = (**base).clone();
    free.iter().zip(values).try_for_each(|(free, value)| free.set(&mut file, *value))?;
    Ok(Scenario::try_from(file)?)
}

/// A point and the seeds of its trials.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// A value for each parameter.
    pub values: Vec<f64>,
    /// Seed of the first trial.
    pub first_seed: u64,
}

/// A trial of a seed, policy by policy.
type OfSeed = Vec<Measured>;

impl Space {
    /// The parameters of the command line for an experiment, and these outcomes.
    ///
    /// # Errors
    /// The experiment has axes, the scenario lacks a parameter, two parameters set one field, or an end of
    /// a range cannot be run.
    pub fn new(experiment: Experiment, specs: &[String], outcomes: Vec<Outcome>) -> Result<Self, Failure> {
        if !experiment.axes.is_empty() {
            refuse!(
                "this sweep has axes; --over varies one scenario: name its file, or a sweep without axes"
            );
        }
        let tree = experiment.base.tree();
        let parse = |spec: &String| Parameter::parse(spec, &tree, &tree);
        let free =
            specs.iter().map(parse).collect::<Result<Vec<_>, _>>().map_err(Failure::input_at("--over"))?;
        let free = free.into_iter().map(|free| free.in_scenario(&experiment.base)).collect::<Vec<_>>();
        let mut paths: Vec<&str> = free.iter().flat_map(|free| free.settings(1.0).map(|(p, _)| p)).collect();
        paths.sort_unstable();
        if let Some([twice, _]) = paths.array_windows().find(|[a, b]| a == b) {
            refuse!("--over: {twice}: is set by two parameters");
        }
        let space = Self { experiment, free, outcomes };
        space.check_ends().map_err(Failure::input_at("--over"))?;
        Ok(space)
    }

    /// Checks that each end of each range alone makes a valid scenario.
    fn check_ends(&self) -> Result<(), PointError> {
        for free in &self.free {
            for end in free.ends() {
                scenario_with(&self.experiment.base, std::slice::from_ref(free), &[end])?;
            }
        }
        Ok(())
    }

    /// The outcomes of all policies in these metrics, then the differences between policies.
    ///
    /// # Errors
    /// An unknown policy.
    pub fn outcomes(
        experiment: &Experiment,
        metrics: &[usize],
        choice: Choice,
    ) -> Result<Vec<Outcome>, Failure> {
        let label = |policy: usize| experiment.policies[policy].label.as_str();
        let name = |metric: usize| experiment.metrics[metric].name.clone();
        let pairs =
            if experiment.policies.len() > 1 { policy_pairs(experiment, choice)? } else { Vec::new() };
        let mut outcomes = Vec::new();
        for metric in metrics.iter().copied() {
            let of = |policy| Outcome {
                metric,
                policy,
                less: None,
                who: label(policy).to_owned(),
                what: name(metric),
            };
            outcomes.extend((0..experiment.policies.len()).map(of));
            outcomes.extend(pairs.iter().map(|[policy, less]| Outcome {
                less: Some(*less),
                who: format!("{} - {}", label(*policy), label(*less)),
                ..of(*policy)
            }));
        }
        Ok(outcomes)
    }

    /// The scenario at a point.
    ///
    /// # Errors
    /// Those of [`scenario_with`].
    pub fn scenario(&self, values: &[f64]) -> Result<Scenario, PointError> {
        scenario_with(&self.experiment.base, &self.free, values)
    }

    /// The parameters' present values in the scenario.
    ///
    /// # Errors
    /// A field is not a number.
    pub fn present(&self) -> Result<Vec<f64>, Failure> {
        let tree = self.experiment.base.tree();
        let present = self.free.iter().map(|free| free.present(&tree)).collect::<Result<_, _>>();
        present.map_err(Failure::input_at("--over"))
    }

    /// The outcomes at these points, each from the experiment's number of trials, on the threads of the
    /// calling pool. `None` if `stop` was set.
    pub fn evaluate(&self, points: &[Point], stop: &AtomicBool) -> Option<Vec<Values>> {
        let scenarios: Vec<Result<Scenario, PointError>> =
            points.iter().map(|point| self.scenario(&point.values)).collect();
        let trials = self.experiment.trials;
        let all: Vec<(usize, u64)> = (0..points.len())
            .filter(|point| scenarios[*point].is_ok())
            .flat_map(|point| (0..trials).map(move |trial| (point, trial)))
            .map(|(point, trial)| (point, points[point].first_seed + u64::from(trial)))
            .collect();
        let run = |(point, seed): &(usize, u64)| {
            let scenario = scenarios[*point].as_ref().map_err(Clone::clone)?;
            self.run_seed(scenario, *seed, stop)
        };
        let mut results: Vec<Result<OfSeed, PointError>> = all.par_iter().map(run).collect();
        if stop.load(Ordering::Relaxed) {
            return None;
        }
        let mut rest = results.drain(..);
        let of_point = |scenario: &Result<Scenario, PointError>| -> Values {
            scenario.as_ref().map_err(Clone::clone)?;
            let seeds: Vec<Result<OfSeed, PointError>> = rest.by_ref().take(trials as usize).collect();
            let seeds = seeds.into_iter().collect::<Result<Vec<OfSeed>, PointError>>()?;
            Ok(self.values(seeds))
        };
        Some(scenarios.iter().map(of_point).collect())
    }

    /// The trials of all policies with a seed. Policies that decide alike share the trial.
    fn run_seed(&self, scenario: &Scenario, seed: u64, stop: &AtomicBool) -> Result<OfSeed, PointError> {
        let (shared, mut sessions) = (SharedTrials::default(), Sessions::default());
        let setup = TrialSetup { scenario, seed, is_checked: self.experiment.is_checked };
        let policies = self.experiment.policies.iter().enumerate();
        let trial = |(number, policy): (usize, &crate::experiment::PolicySpec)| {
            let run = AssertUnwindSafe(|| {
                let player = sessions.of(number, policy.made());
                shared.run(0, &setup, player.map_err(|error| Fault::of_policy(&error))?, stop)
            });
            let failed = |reason: String| PointError::Trial { policy: policy.label.clone(), seed, reason };
            let result = catch_unwind(run)
                .map_err(|panic| failed(format!("internal error: {}", panic_message(&*panic))))?;
            let trial = result.map_err(|fault| failed(fault.reason))?;
            Ok(Measured::of_record(&trial.record, &self.experiment.metrics))
        };
        policies.map(trial).collect()
    }

    /// The outcomes over these seeds.
    fn values(&self, seeds: Vec<OfSeed>) -> Vec<Option<f64>> {
        let of_seed = |(trial, measured): (u32, OfSeed)| {
            measured.into_iter().enumerate().map(move |(policy, one)| ((0, policy, trial), one))
        };
        let results: Results = (1..).zip(seeds).flat_map(of_seed).collect();
        let trials = Trials::new(&self.experiment.metrics, &results, 1..=self.experiment.trials);
        let value = |outcome: &Outcome| {
            let of = |policy: usize| ((0, policy), outcome.metric);
            match outcome.less {
                None => trials.moments(of(outcome.policy)).mean,
                Some(less) => trials.pairs([of(outcome.policy), of(less)]).difference(),
            }
        };
        self.outcomes.iter().map(value).collect()
    }
}
