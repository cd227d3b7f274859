//! One decision of a study: the question, and the outcome of every assignment.

use scenario::seed::trial_number;
use serde::{Deserialize, Serialize};
use teaming::{
    Asked, Assignment, Deadline, Decision, Member, PolicyError, Question, Session, TrialStart, assignments,
};
use usar_sim::simulation::{Advance, Simulation};

use crate::oracle::{BranchError, Coverage, Evaluation, Objective, Outcome, Survey, play, survey};

/// A decision, and the outcomes of the assignments that were played.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlayedDecision {
    /// The question, with the results of earlier rounds.
    pub question: Question,
    /// The members as they really were; absent where the question had them as they were.
    pub truth: Option<Vec<Member>>,
    /// Time of the question, in seconds.
    pub time_s: f64,
    /// The assignment that the trial went on with.
    pub chosen: Assignment,
    /// The assignments that were played; `None` for all that the quotas allow, in the order of
    /// [`teaming::assignments::all`].
    pub sample: Option<Sample>,
    /// The outcome of each assignment.
    pub outcomes: Vec<Outcome>,
}

/// The assignments that were played, if there are too many to play all.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// The assignments.
    pub assignments: Vec<Assignment>,
    /// Number of assignments that were drawn or named; the local search added the others.
    pub drawn: usize,
}

impl PlayedDecision {
    /// The members as they really were, by id.
    pub fn team(&self) -> &[Member] {
        self.truth.as_ref().unwrap_or(&self.question.members)
    }

    /// The question as it would have been if all members had been reported as they were.
    pub fn true_question(&self) -> Question {
        Question { members: self.team().to_vec(), ..self.question.clone() }
    }

    /// The assignments and their outcomes.
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

/// Settings for playing decisions.
pub struct Plan<'a> {
    /// The objective of the local search, which is used if not all assignments can be played.
    pub objective: &'a Objective,
    /// Largest number of assignments played for one decision.
    pub limit: u64,
    /// Decides the rest of the trial; `None` to play to the end of the round only.
    pub onwards: Option<Box<dyn Session>>,
    /// Sessions of the policies whose choices are always played.
    pub named: Vec<Box<dyn Session>>,
    /// The rounds whose decisions are played; empty for all.
    pub rounds: &'a [u32],
    /// When to stop.
    pub halt: Deadline<'a>,
}

/// Plays a trial in which a session decides. At each decision, every other assignment is played as well.
///
/// # Errors
/// The trial or a branch of it fails, or it was halted.
pub fn play_decisions(
    mut trial: Simulation,
    session: &mut dyn Session,
    plan: &mut Plan,
) -> Result<Vec<PlayedDecision>, BranchError> {
    let seed = trial.seed();
    let failed = |error: &dyn std::fmt::Display| BranchError::Failed(format!("seed {seed}: {error}"));
    let scenario = trial.scenario().name.clone();
    let start = TrialStart { scenario: &scenario, number: trial_number(seed) };
    session.reset(&start)?;
    plan.named.iter_mut().try_for_each(|session| session.reset(&start))?;
    let mut played = Vec::new();
    loop {
        let question = match trial.advance() {
            Advance::Running => continue,
            Advance::Over(usar_sim::record::Status::Failed(reason)) => return Err(failed(&reason)),
            Advance::Over(_) => return Ok(played),
            Advance::Asks(_) => trial.question().cloned(),
        };
        let Some(question) = question else { continue };
        let team = trial.team();
        let asked = Asked::of(&question).knowing(&team);
        let asked = asked.within(&trial).until(plan.halt);
        let decision = session.decide(&asked).map_err(|error| match error {
            PolicyError::Late if plan.halt.is_over() => BranchError::Halted,
            error => failed(&error),
        })?;
        if plan.rounds.is_empty() || plan.rounds.contains(&question.round) {
            played.push(plan.play(&trial, question, &decision)?);
        }
        trial.assign(decision).map_err(|error| failed(&error))?;
    }
}

impl Plan<'_> {
    fn play(
        &mut self,
        trial: &Simulation,
        question: Question,
        decision: &Decision,
    ) -> Result<PlayedDecision, BranchError> {
        let (start, team) = (trial.checkpoint(), trial.team());
        let mut named = vec![decision.assignment.clone()];
        for session in &mut self.named {
            // A policy that cannot group this team is skipped. The tables leave it out, too.
            let asked = Asked::of(&question).knowing(&team).until(self.halt);
            named.extend(session.decide(&asked).map(|decision| decision.assignment));
        }
        let (halt, onwards) = (self.halt, &mut self.onwards);
        let mut outcome =
            |assignment: &Assignment| play(&start, Decision::of(assignment.clone()), onwards.as_mut(), halt);
        let survey = survey(&question, self.objective, self.limit, &named, |batch| {
            batch.iter().map(&mut outcome).collect::<Result<Vec<Outcome>, BranchError>>()
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
        let (truth, time_s) = (trial.truth(), trial.time_s());
        Ok(PlayedDecision { question, truth, time_s, chosen, sample, outcomes })
    }
}
