//! Policies judged without their trials: by the outcomes of all assignments, which a study of regret has
//! played, and by the questions of trials that DIS decides. DIS hears nothing of what robots say, so that a
//! lie changes the evidence of its trials and nothing else: one trial for each lie and seed has the questions
//! of all policies. What comes out is a filter: no decision here changes the rounds after it.

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;
use serde::Serialize;
use statistics::Moments;
use statistics::comparison::Pairs;
use teaming::{Asked, Assignment, Deadline, Member, PolicyError, Question, Session, TrialStart};
use usar_sim::simulation::{Advance, Ask, Simulation};

use super::cells::{DEAF, Difference, Lie, lies};
use crate::experiment::{Experiment, PolicySpec};
use crate::oracle::{Objective, Survey};
use crate::regret::{PlayedDecision, PlayedTrial, StudyFolder};
use crate::{Failure, refuse};

/// What the decisions of a policy were worth under one lie.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Worth {
    /// Label of the policy.
    pub policy: String,
    /// The lie.
    pub lie: String,
    /// For each number of liars: the value of its assignments minus the mean of all assignments, over the
    /// decisions of a trial and then over trials.
    pub differences: Vec<Difference>,
}

/// What came of the decisions of a sweep's policies, by the outcomes of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// Name of the objective.
    pub objective: String,
    /// Numbers of liars.
    pub counts: Vec<u32>,
    /// Number of trials.
    pub trials: usize,
    /// Each policy under each lie.
    pub worths: Vec<Worth>,
}

/// For each policy, its mean difference in one trial of one case.
type OfTrial = Vec<Option<f64>>;

impl Replay {
    /// Asks every policy of a sweep at the decisions of a study's trials that DIS decided, and calls `done`
    /// after each trial.
    ///
    /// # Errors
    /// The sweep has no axis of numbers of liars; the study has no trial of DIS, or is of another world; a
    /// policy fails; or it was halted.
    pub fn of(
        experiment: &Experiment,
        study: &StudyFolder,
        objective: &Objective,
        halt: &AtomicBool,
        done: impl Fn() + Sync,
    ) -> Result<Self, Failure> {
        let (counts, lies) = lies(experiment)?;
        let trials: Vec<&PlayedTrial> =
            study.folder.entries.iter().filter(|trial| trial.driver == DEAF).collect();
        if trials.is_empty() {
            refuse!("{}: must have trials that {DEAF} decided, found none", study.folder.path.display());
        }
        let jobs: Vec<[usize; 2]> = (0..experiment.cases.len())
            .flat_map(|case| (0..trials.len()).map(move |trial| [case, trial]))
            .collect();
        let played: Vec<OfTrial> = jobs
            .into_par_iter()
            .map(|[case, trial]| {
                let found = of_trial(experiment, case, trials[trial], objective, halt);
                done();
                found
            })
            .collect::<Result<_, Failure>>()?;
        let difference = |policy: usize, case: usize| {
            let rows = &played[case * trials.len()..(case + 1) * trials.len()];
            // One trial without a value, and the mean would be of some of the trials only.
            let values: Vec<f64> =
                rows.iter().map(|row| row[policy]).collect::<Option<_>>().unwrap_or_default();
            let b = vec![0.0; values.len()];
            Difference::of(&Pairs { a: values, b, ..Pairs::default() })
        };
        let worth = |policy: usize, spec: &PolicySpec, lie: &Lie| Worth {
            policy: spec.label.clone(),
            lie: lie.name.clone(),
            differences: lie.cases.iter().map(|case| difference(policy, *case)).collect(),
        };
        let policies = experiment.policies.iter().enumerate();
        let worths = policies.flat_map(|(place, spec)| lies.iter().map(move |lie| (place, spec, lie)));
        Ok(Self {
            objective: objective.name().to_owned(),
            counts,
            trials: trials.len(),
            worths: worths.map(|(place, spec, lie)| worth(place, spec, lie)).collect(),
        })
    }
}

/// Plays a trial of a case with DIS, and asks all policies at each of its decisions.
fn of_trial(
    experiment: &Experiment,
    case: usize,
    played: &PlayedTrial,
    objective: &Objective,
    halt: &AtomicBool,
) -> Result<OfTrial, Failure> {
    let failed = |error: &dyn std::fmt::Display| Failure::run(format!("seed {}: {error}", played.seed));
    let open = |spec: &PolicySpec| spec.made().open().map_err(|error| failed(&error));
    let mut sessions = experiment.policies.iter().map(open).collect::<Result<Vec<_>, _>>()?;
    let mut deaf = experiment.registry.open(DEAF).map_err(|error| failed(&error))?;
    let scenario = &experiment.cases[case].scenario;
    let start = TrialStart { scenario: &scenario.name, seed: played.seed };
    sessions.iter_mut().try_for_each(|session| session.reset(&start)).map_err(|error| failed(&error))?;
    let mut trial = Simulation::new(scenario, played.seed).map_err(|error| failed(&error))?;
    let outcomes: BTreeMap<u32, &PlayedDecision> =
        played.decisions.iter().map(|decision| (decision.question.round, decision)).collect();
    let mut worths = vec![Some(Vec::new()); sessions.len()];
    loop {
        let question = match trial.advance() {
            Advance::Running => continue,
            Advance::Over(_) => break,
            Advance::Asks(Ask::Grouping(question)) => question.clone(),
        };
        if Deadline::when(halt).is_over() {
            return Err(Failure::Interrupted("stopped; nothing was written".to_owned()));
        }
        let team = trial.team();
        let asked = Asked::of(&question).knowing(&team);
        let decision = deaf.decide(&asked).map_err(|error| failed(&error))?;
        if let Some(known) = outcomes.get(&question.round) {
            if known.chosen != decision.assignment || !is_of_world(known, &question, &team) {
                refuse!("the study is of another world: seed {}, round {}", played.seed, question.round);
            }
            let survey = known.survey();
            let values = values(&survey, objective);
            for (session, worths) in sessions.iter_mut().zip(&mut worths) {
                // One answer that was not played, and the mean would be of some of the decisions only.
                match worth(&mut **session, &asked, &values).map_err(|error| failed(&error))? {
                    Some(one) => worths.iter_mut().for_each(|worths| worths.push(one)),
                    None => *worths = None,
                }
            }
        }
        trial.assign(decision).map_err(|error| failed(&error))?;
    }
    Ok(worths.into_iter().map(|worths| Moments::of(&worths?).mean).collect())
}

/// Whether a decision of a study is that of this question: the same tasks and sizes for the same team, which
/// may have said something else of itself.
fn is_of_world(known: &PlayedDecision, question: &Question, team: &[Member]) -> bool {
    let asked = &known.question;
    let is_same_team = known.team() == team;
    let tables =
        asked.tasks == question.tasks && asked.needs == question.needs && asked.roles == question.roles;
    tables && asked.quotas == question.quotas && is_same_team
}

/// The value of each assignment that was played and has one.
fn values<'s>(survey: &'s Survey, objective: &Objective) -> BTreeMap<&'s Assignment, f64> {
    let of = |one: &'s crate::oracle::Evaluation| Some((&one.assignment, objective.value(&one.outcome)?));
    survey.evaluations.iter().filter_map(of).collect()
}

/// The value of a policy's assignment minus the mean of all; `None` if it was not played.
fn worth(
    session: &mut dyn Session,
    asked: &Asked<'_>,
    values: &BTreeMap<&Assignment, f64>,
) -> Result<Option<f64>, PolicyError> {
    let decision = session.decide(asked)?;
    let mean = values.values().sum::<f64>() / values.len() as f64;
    Ok(values.get(&decision.assignment).map(|value| value - mean))
}
