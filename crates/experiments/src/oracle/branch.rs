//! One branch of a trial: a decision and its outcome.

use scenario::seed::trial_number;
use serde::{Deserialize, Serialize};
use store::Failure;
use teaming::{AssignmentError, Deadline, Decision, PolicyError, Session, TrialStart};
use usar_sim::metrics::TaskTotals;
use usar_sim::record::{Status, TrialRecord};
use usar_sim::simulation::{Advance, AssignError, Checkpoint, InTime, Simulation};

/// A branch checks once in this many steps whether it is to stop.
const HALT_CHECK_STEPS: u64 = 64;

/// The outcome of a decision, from the moment of the decision on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// For each task, the deliveries and costs.
    pub tasks: Vec<TaskTotals>,
    /// Percent points of energy and of HP that robots spent outside any group.
    pub ungrouped: [f64; 2],
    /// Simulated time that the outcome covers, in seconds.
    pub duration_s: f64,
    /// Whether the trial ended before the round did.
    pub is_cut: bool,
}

impl Outcome {
    /// The totals of all tasks, with the costs outside any group.
    pub fn total(&self) -> TaskTotals {
        let [energy, hp] = self.ungrouped;
        let start = TaskTotals { energy, hp, ..TaskTotals::default() };
        self.tasks.iter().fold(start, |sum, task| TaskTotals {
            rescued: sum.rescued + task.rescued,
            secured: sum.secured + task.secured,
            energy: sum.energy + task.energy,
            hp: sum.hp + task.hp,
        })
    }

    /// The counts of a trial so far.
    fn so_far(trial: &Simulation) -> Self {
        let metrics = trial.metrics();
        Self {
            tasks: metrics.tasks.clone(),
            ungrouped: metrics.ungrouped,
            duration_s: trial.time_s(),
            is_cut: false,
        }
    }

    fn since(&self, before: &Self, is_cut: bool) -> Self {
        let pairs = self.tasks.iter().zip(&before.tasks);
        let difference = |(now, then): (&TaskTotals, &TaskTotals)| TaskTotals {
            rescued: now.rescued - then.rescued,
            secured: now.secured - then.secured,
            energy: now.energy - then.energy,
            hp: now.hp - then.hp,
        };
        Self {
            tasks: pairs.map(difference).collect(),
            ungrouped: [0, 1].map(|i| self.ungrouped[i] - before.ungrouped[i]),
            duration_s: self.duration_s - before.duration_s,
            is_cut,
        }
    }
}

/// Why a branch has no outcome.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BranchError {
    /// The trial asks nothing at that moment.
    #[error("the trial asks for no assignment")]
    NotAsked,
    /// The trial was over before the round began.
    #[error("the trial is over before round {round}: it ends at {time_s:.1} s, {status}")]
    NoSuchRound {
        /// The round that was asked for.
        round: u32,
        /// When the trial ended, in seconds.
        time_s: f64,
        /// How it ended.
        status: String,
    },
    /// The decision does not answer the question.
    #[error(transparent)]
    Refused(#[from] AssignmentError),
    /// A policy cannot begin the trial.
    #[error("the policy failed: {0}")]
    Policy(#[from] PolicyError),
    /// The trial failed.
    #[error("{0}")]
    Failed(String),
    /// The branch was told to stop.
    #[error("it was halted")]
    Halted,
}

impl From<BranchError> for Failure {
    fn from(error: BranchError) -> Self {
        match error {
            BranchError::Halted => Self::Interrupted("stopped".to_owned()),
            BranchError::NoSuchRound { .. } => Self::input(format!("--round: {error}")),
            BranchError::Refused(_) => Self::input(error),
            error => Self::run(error),
        }
    }
}

/// Lets a session play a trial from its start until the question of a round awaits its answer.
///
/// # Errors
/// The trial ends before that round, fails, or is halted.
pub fn advance_to(
    trial: &mut Simulation,
    session: &mut dyn Session,
    round: u32,
    halt: Deadline<'_>,
) -> Result<(), BranchError> {
    reset(session, trial)?;
    loop {
        // `advance` stops at a question, whereas `step` would let the session answer it. The round is
        // checked in between.
        match trial.advance() {
            Advance::Asks(ask) if ask.round() == round => return Ok(()),
            Advance::Over(Status::Failed(reason)) => return Err(failed(reason, halt)),
            Advance::Over(status) => {
                let status = status.name().replace('_', " ");
                return Err(BranchError::NoSuchRound { round, time_s: trial.time_s(), status });
            }
            Advance::Running => look(trial, halt)?,
            Advance::Asks(_) => {
                trial.step(InTime::new(&mut *session, halt));
            }
        }
    }
}

/// A trial that failed, unless that is because a session gave up when it was told to stop.
fn failed(reason: String, halt: Deadline<'_>) -> BranchError {
    if halt.is_over() { BranchError::Halted } else { BranchError::Failed(reason) }
}

/// Lets a session know whose questions it answers.
fn reset(session: &mut dyn Session, trial: &Simulation) -> Result<(), BranchError> {
    Ok(session.reset(&TrialStart { scenario: &trial.scenario().name, number: trial_number(trial.seed()) })?)
}

fn look(trial: &Simulation, halt: Deadline<'_>) -> Result<(), BranchError> {
    let is_halted = trial.steps().is_multiple_of(HALT_CHECK_STEPS) && halt.is_over();
    if is_halted { Err(BranchError::Halted) } else { Ok(()) }
}

/// A trial that continues from a decision.
pub struct Branch {
    trial: Simulation,
    /// The counts at the moment of the decision.
    before: Outcome,
    round: u32,
}

impl Branch {
    /// Decides in a trial whose question awaits its answer.
    ///
    /// # Errors
    /// No question is open, or the decision does not answer it.
    pub fn begin(start: &Checkpoint, decision: Decision) -> Result<Self, BranchError> {
        let mut trial = start.resume();
        let round = trial.question().ok_or(BranchError::NotAsked)?.round;
        let before = Outcome::so_far(&trial);
        trial.assign(decision).map_err(|error| match error {
            AssignError::Refused(error) => BranchError::Refused(error),
            _ => BranchError::NotAsked,
        })?;
        Ok(Self { trial, before, round })
    }

    /// Continues to the end of the round, or of the trial if that comes first.
    ///
    /// # Errors
    /// The trial fails or is halted.
    pub fn to_round_end(&mut self, halt: Deadline<'_>) -> Result<Outcome, BranchError> {
        let is_cut = loop {
            match self.trial.advance() {
                Advance::Running => look(&self.trial, halt)?,
                Advance::Asks(ask) if ask.round() > self.round => break false,
                Advance::Asks(_) => return Err(BranchError::NotAsked),
                Advance::Over(Status::Failed(reason)) => return Err(failed(reason, halt)),
                Advance::Over(_) => break true,
            }
        };
        Ok(Outcome::so_far(&self.trial).since(&self.before, is_cut))
    }

    /// Continues to the end of the trial; `onwards` answers the later questions.
    ///
    /// # Errors
    /// The trial fails or is halted.
    pub fn to_trial_end(
        &mut self,
        onwards: &mut dyn Session,
        halt: Deadline<'_>,
    ) -> Result<Outcome, BranchError> {
        reset(onwards, &self.trial)?;
        loop {
            match self.trial.step(InTime::new(&mut *onwards, halt)) {
                None => look(&self.trial, halt)?,
                Some(Status::Failed(reason)) => return Err(failed(reason, halt)),
                Some(_) => return Ok(Outcome::so_far(&self.trial).since(&self.before, false)),
            }
        }
    }

    /// The record of the trial up to now.
    pub fn finish(self) -> TrialRecord {
        self.trial.finish()
    }
}

/// The outcome of a decision: to the end of the round, or, if a policy continues, to the end of the trial.
///
/// # Errors
/// The decision does not answer the question; the trial fails or is halted.
pub fn play(
    start: &Checkpoint,
    decision: Decision,
    onwards: Option<&mut Box<dyn Session>>,
    halt: Deadline<'_>,
) -> Result<Outcome, BranchError> {
    let mut branch = Branch::begin(start, decision)?;
    match onwards {
        None => branch.to_round_end(halt),
        Some(session) => branch.to_trial_end(&mut **session, halt),
    }
}
