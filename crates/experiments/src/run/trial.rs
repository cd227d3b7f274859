//! One trial of a sweep: its key, and its results.

use std::sync::atomic::{AtomicBool, Ordering};

use ron_tree::Problem;
use scenario::Scenario;
use scenario::seed::trial_number;
use serde::{Deserialize, Serialize};
use teaming::{Deadline, PolicyError, Session, TrialStart};
use usar_sim::event::Event;
use usar_sim::fit::Tables;
use usar_sim::record::{Status, TrialRecord};
use usar_sim::simulation::{InTime, Simulation};

/// The reason of a trial that ended because its policy gave up at the deadline.
pub(super) const UNANSWERED: &str = "its policy did not answer in time";

/// The reason of a trial that ended because it was told to.
pub(super) const HALTED: &str = "it was halted";

/// Time between two points of a series, in seconds.
const SERIES_PERIOD_S: f64 = 10.0;

/// Names one trial of a sweep.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct TrialKey {
    /// Number of the case, from 0.
    pub case: usize,
    /// Place of the policy in the sweep's list.
    pub policy: usize,
    /// Number of the trial, from 1. Trials of the same case and number are pairs: they share their seed.
    pub trial: u32,
    /// Seed of the trial.
    pub seed: u64,
    /// The policy's label in the sweep.
    pub label: String,
}

/// A trial that ran to its end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// Its record.
    pub record: TrialRecord,
    /// For each task, the times of the deliveries from it, in seconds.
    pub deliveries: Vec<Vec<f64>>,
}

impl Trial {
    /// Checks that this can be the trial of a scenario with this seed.
    ///
    /// # Errors
    /// The first value that does not fit.
    pub fn check(&self, scenario: &Scenario, seed: u64) -> Result<(), Box<Problem>> {
        let mut tables = Tables::of(scenario);
        if scenario.is_drawn() {
            tables.robots = self.record.robots.len(); // their number may be drawn
        }
        if self.record.seed != seed {
            return Err(Box::new(Problem::new("seed", format!("must be {seed}"), self.record.seed)));
        }
        if self.deliveries.len() != tables.tasks.len() {
            let rule = format!("must have {} entries, one for each task", tables.tasks.len());
            return Err(Box::new(Problem::new("deliveries", rule, self.deliveries.len())));
        }
        tables.check_record(&self.record)
    }

    /// Rescuees delivered up to a time in seconds, from each task.
    pub fn delivered(&self, time_s: f64) -> Vec<usize> {
        self.deliveries.iter().map(|times| times.partition_point(|at| *at <= time_s)).collect()
    }
}

/// The times in seconds at which series report the deliveries.
pub fn series_times(duration_s: f64) -> impl Iterator<Item = f64> {
    (0..).map(|i| f64::from(i) * SERIES_PERIOD_S).take_while(move |time| *time <= duration_s)
}

/// Why a trial has no numbers.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fault {
    /// The kind of fault.
    pub kind: FaultKind,
    /// Description of the fault, in a sentence.
    pub reason: String,
}

ron_tree::named! {
    /// Kinds of faults.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum FaultKind {
        /// The trial reported it: an invariant was violated, a policy failed, or the physics broke down.
        Failed = "failed",
        /// The program has a defect.
        Panicked = "panicked",
        /// The trial exceeded the time limit.
        TimedOut = "timed_out",
    }
}

impl Fault {
    /// The policy of the trial failed.
    pub fn of_policy(error: &PolicyError) -> Self {
        let is_late = matches!(error, PolicyError::Late | PolicyError::Slow(_));
        let kind = if is_late { FaultKind::TimedOut } else { FaultKind::Failed };
        Self { kind, reason: format!("the policy failed: {error}") }
    }

    /// A sentence with the trial and its fault.
    pub fn sentence(&self, key: &TrialKey) -> String {
        let TrialKey { label, trial, seed, .. } = key;
        let kind = self.kind.name().replace('_', " ");
        format!("trial {trial} of {label} (seed {seed}) {kind}: {}", self.reason)
    }
}

/// The outcome of a trial.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// The trial.
    pub key: TrialKey,
    /// The trial's results, or its fault.
    pub result: Result<Trial, Fault>,
}

impl Outcome {
    /// Its record, if the trial ran to its end.
    pub fn record(&self) -> Option<&TrialRecord> {
        self.result.as_ref().ok().map(|trial| &trial.record)
    }

    /// Its status in one word, for tables.
    pub fn status(&self) -> &'static str {
        self.result.as_ref().map_or_else(|fault| fault.kind.name(), |trial| trial.record.status.name())
    }

    /// Why the trial has no results, in one sentence; `None` if it has.
    pub fn failure(&self) -> Option<String> {
        Some(self.result.as_ref().err()?.sentence(&self.key))
    }
}

/// A trial that is to be run.
#[derive(Clone, Copy)]
pub struct TrialSetup<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// The seed.
    pub seed: u64,
    /// Whether every invariant is checked at every step.
    pub is_checked: bool,
}

impl TrialSetup<'_> {
    /// The trial as a session gets to know it.
    pub fn start(&self) -> TrialStart<'_> {
        TrialStart { scenario: &self.scenario.name, number: trial_number(self.seed) }
    }
}

/// Runs one trial; `halt` ends it early.
///
/// # Errors
/// The layout cannot be drawn, the trial failed, or it was halted.
pub fn run_trial(setup: &TrialSetup, session: &mut dyn Session, halt: &AtomicBool) -> Result<Trial, Fault> {
    let failed = |reason: String| Fault { kind: FaultKind::Failed, reason };
    let late = |reason: &str| Fault { kind: FaultKind::TimedOut, reason: reason.to_owned() };
    let simulation =
        Simulation::new(setup.scenario, setup.seed).map_err(|error| failed(error.to_string()))?;
    session.reset(&setup.start()).map_err(|error| Fault::of_policy(&error))?;
    let mut simulation = if setup.is_checked { simulation.checked() } else { simulation };
    let mut session = InTime::new(session, Deadline::when(halt));
    let mut deliveries = vec![Vec::new(); setup.scenario.tasks.len()];
    while simulation.step(&mut session).is_none() {
        if halt.load(Ordering::Relaxed) {
            return Err(late(HALTED));
        }
        for event in simulation.events() {
            if let Event::Delivered { rescuee, .. } = event {
                let task = simulation.world().rescuees[rescuee.index()].task;
                deliveries[task.index()].push(simulation.time_s());
            }
        }
    }
    let record = simulation.finish();
    match record.status {
        Status::Failed(reason) if reason.ends_with(&PolicyError::Late.to_string()) => Err(late(UNANSWERED)),
        Status::Failed(reason) if is_slow(&reason) => Err(late(&reason)),
        Status::Failed(reason) => Err(failed(reason)),
        _ => Ok(Trial { record, deliveries }),
    }
}

/// Whether a trial failed because its policy took longer than the policy's own limit.
fn is_slow(reason: &str) -> bool {
    reason.contains(&PolicyError::Slow(String::new()).to_string())
}
