//! One decision of a study: the question, and what comes of every assignment.

use std::sync::atomic::AtomicBool;

use rne_core::{Assignment, Decision, Policy, Question, assignments};
use serde::{Deserialize, Serialize};
use usar_sim::scenario::Scenario;
use usar_sim::simulation::{Advance, Decider, Simulation};

use crate::oracle::{BranchError, Coverage, Evaluation, Objective, Outcome, Survey, play, survey};

/// A decision, and what comes of every assignment that was played.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlayedDecision {
    /// What was asked, with what earlier rounds came to.
    pub question: Question,
    /// When, in seconds.
    pub time_s: f64,
    /// What was answered in this trial.
    pub chosen: Assignment,
    /// The assignments that were played; `None` for all that the quotas allow, in the order of
    /// [`rne_core::assignments::all`].
    pub sample: Option<Sample>,
    /// What came of each.
    pub outcomes: Vec<Outcome>,
}

/// The assignments that were played where there are too many for all.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// The assignments.
    pub assignments: Vec<Assignment>,
    /// Those that were drawn or named.
    pub drawn: usize,
}

impl PlayedDecision {
    /// The assignments and what came of them.
    #[must_use]
    pub fn survey(&self) -> Survey {
        let (all, coverage) = match &self.sample {
            None => (assignments::all(&self.question), Coverage::All),
            Some(Sample { assignments, drawn }) => {
                let of = assignments::count(&self.question);
                let coverage = Coverage::Sample { of, drawn: *drawn, searched: assignments.len() - drawn };
                (assignments.clone(), coverage)
            }
        };
        let pairs = all.into_iter().zip(self.outcomes.iter().cloned());
        let evaluations = pairs.map(|(assignment, outcome)| Evaluation { assignment, outcome }).collect();
        Survey { evaluations, coverage }
    }
}

/// How decisions are played.
pub struct Plan<'a> {
    /// What a local search looks for where not all assignments can be played.
    pub objective: &'a Objective,
    /// Most assignments of one decision.
    pub limit: u64,
    /// The policy that decides the rest of the trial; none to play to the end of the round.
    pub onwards: Option<&'a dyn Policy>,
    /// Policies whose choices are played in any case.
    pub named: &'a [&'a dyn Policy],
    /// The rounds that are played; empty for all.
    pub rounds: &'a [u32],
}

/// Plays a trial in which `driver` decides, and at each decision every other assignment.
///
/// # Errors
/// The layout cannot be drawn, the trial or a branch of it fails, or it was halted.
pub fn play_decisions(
    (scenario, seed): (&Scenario, u64),
    driver: &(impl Decider + ?Sized),
    plan: &Plan,
    halt: &AtomicBool,
) -> Result<Vec<PlayedDecision>, BranchError> {
    let failed = |error: &dyn std::fmt::Display| BranchError::Failed(format!("seed {seed}: {error}"));
    let mut trial = Simulation::new(scenario, seed).map_err(|error| failed(&error))?;
    let mut played = Vec::new();
    loop {
        let question = match trial.advance() {
            Advance::Running => continue,
            Advance::Over(usar_sim::record::Status::Failed(reason)) => return Err(failed(&reason)),
            Advance::Over(_) => return Ok(played),
            Advance::Asks(question) => question.clone(),
        };
        let decision = driver.decide(&trial, &question).map_err(|error| failed(&error))?;
        if plan.rounds.is_empty() || plan.rounds.contains(&question.round) {
            played.push(plan.play(&trial, question, &decision, halt)?);
        }
        trial.assign(decision).map_err(|error| failed(&error))?;
    }
}

impl Plan<'_> {
    fn play(
        &self,
        trial: &Simulation,
        question: Question,
        decision: &Decision,
        halt: &AtomicBool,
    ) -> Result<PlayedDecision, BranchError> {
        let start = trial.checkpoint();
        let mut named = vec![decision.assignment.clone()];
        for policy in self.named {
            // A policy that cannot group this team is left out of the tables, too.
            named.extend(policy.decide(&question).map(|decision| decision.assignment));
        }
        let outcome = |assignment: &Assignment| {
            play(&start, Decision::unscored(assignment.groups.clone()), self.onwards, halt)
        };
        let survey = survey(&question, (self.objective, self.limit), &named, |batch| {
            batch.iter().map(outcome).collect::<Result<Vec<Outcome>, BranchError>>()
        })?;
        let (assignments, outcomes): (Vec<_>, Vec<_>) = survey
            .evaluations
            .into_iter()
            .map(|Evaluation { assignment, outcome }| (assignment, outcome))
            .unzip();
        let sample = match survey.coverage {
            Coverage::All => None,
            Coverage::Sample { drawn, .. } => Some(Sample { assignments, drawn }),
        };
        let chosen = decision.assignment.clone();
        Ok(PlayedDecision { question, time_s: trial.time_s(), chosen, sample, outcomes })
    }
}
