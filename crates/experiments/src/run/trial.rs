//! One trial of a sweep: its key, and its results.

use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};
use usar_sim::event::Event;
use usar_sim::record::{Status, TrialRecord};
use usar_sim::scenario::Scenario;
use usar_sim::simulation::{Decider, Simulation};

/// A trial checks once in this many steps whether it is to stop.
const HALT_CHECK_STEPS: u64 = 64;

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
    /// Rescuees delivered up to a time in seconds, from each task.
    #[must_use]
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

/// Kinds of faults.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum FaultKind {
    /// The trial reported it: an invariant was violated, a policy failed, or the physics broke down.
    Failed,
    /// The program has a defect.
    Panicked,
    /// The trial exceeded the time limit.
    TimedOut,
}

impl FaultKind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Failed, Self::Panicked, Self::TimedOut];

    /// Name as one word, for tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Failed => "failed",
            Self::Panicked => "panicked",
            Self::TimedOut => "timed_out",
        }
    }
}

impl Fault {
    /// A sentence with the trial and its fault.
    #[must_use]
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
    #[must_use]
    pub fn record(&self) -> Option<&TrialRecord> {
        self.result.as_ref().ok().map(|trial| &trial.record)
    }

    /// Its status in one word, for tables.
    #[must_use]
    pub fn status(&self) -> &'static str {
        self.result.as_ref().map_or_else(|fault| fault.kind.name(), |trial| trial.record.status.name())
    }

    /// Why the trial has no results, in one sentence; `None` if it has.
    #[must_use]
    pub fn failure(&self) -> Option<String> {
        Some(self.result.as_ref().err()?.sentence(&self.key))
    }
}

/// Runs one trial; `halt` ends it early.
///
/// # Errors
/// The layout cannot be drawn, the trial failed, or it was halted.
pub fn run_trial(
    scenario: &Scenario,
    decider: &(impl Decider + ?Sized),
    seed: u64,
    is_checked: bool,
    halt: &AtomicBool,
) -> Result<Trial, Fault> {
    let failed = |reason: String| Fault { kind: FaultKind::Failed, reason };
    let simulation = Simulation::new(scenario, seed).map_err(|error| failed(error.to_string()))?;
    let mut simulation = if is_checked { simulation.checked() } else { simulation };
    let mut deliveries = vec![Vec::new(); scenario.tasks.len()];
    while simulation.step(decider).is_none() {
        if simulation.steps().is_multiple_of(HALT_CHECK_STEPS) && halt.load(Ordering::Relaxed) {
            return Err(failed("it was halted".to_owned()));
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
        Status::Failed(reason) => Err(failed(reason)),
        _ => Ok(Trial { record, deliveries }),
    }
}
