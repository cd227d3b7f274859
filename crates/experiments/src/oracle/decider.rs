//! `ORACLE`: chooses the assignment with the best outcome, known by playing every assignment. It is not a
//! policy, because it sees the trial that asks.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use rne_core::{Account, Alternative, Assignment, Decision, Policy, PolicyError, PolicyKind, Question};
use serde::{Deserialize, Serialize};
use usar_sim::simulation::{Decider, Simulation};

use super::DEFAULT_LIMIT;
use super::branch::{BranchError, play};
use super::objective::Objective;
use super::survey::{Coverage, survey};
use crate::metric::task_names;

/// How far the oracle looks ahead.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Horizon {
    /// To the end of the round.
    Round,
    /// To the end of the trial. Another policy decides the later rounds.
    Trial,
}

/// Options of `ORACLE`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OracleOptions {
    /// The metric that it maximises, or minimises if it is a cost.
    pub metric: String,
    /// How far it looks ahead.
    pub horizon: Horizon,
    /// The policy that decides after the round, if the horizon is the trial.
    pub then: String,
    /// Largest number of assignments that it plays for one decision.
    pub limit: u64,
}

impl Default for OracleOptions {
    fn default() -> Self {
        Self {
            metric: "rescuees.total".to_owned(),
            horizon: Horizon::Round,
            then: "RNE".to_owned(),
            limit: DEFAULT_LIMIT,
        }
    }
}

impl OracleOptions {
    /// The policy that decides the rest of the trial; `None` for a horizon of one round.
    ///
    /// # Errors
    /// Those of `make`.
    pub fn onwards<E>(
        &self,
        make: impl FnOnce(&str) -> Result<Arc<dyn Policy>, E>,
    ) -> Result<Option<Arc<dyn Policy>>, E> {
        (self.horizon == Horizon::Trial).then(|| make(&self.then)).transpose()
    }
}

/// `ORACLE` without a trial to play in: it cannot answer.
#[derive(Debug, Clone)]
pub struct NotSimulated(
    /// Its options.
    pub OracleOptions,
);

impl NotSimulated {
    /// Name of the oracle among the policies.
    pub const NAME: &'static str = "ORACLE";

    /// The oracle's entry in the registry.
    #[must_use]
    pub fn kind() -> PolicyKind {
        let about = "the assignment of which most comes in the round, known by playing them all";
        PolicyKind::with_options(Self::NAME, about, |options: OracleOptions| match options.limit {
            2..=1_000_000 => Ok(Self(options)),
            found => Err(format!("limit must be from 2 to 1000000, found {found}")),
        })
    }
}

impl Policy for NotSimulated {
    fn decide(&self, _question: &Question) -> Result<Decision, PolicyError> {
        let reason = "ORACLE plays each assignment in the trial that asks; here is no trial";
        Err(PolicyError::Other(reason.to_owned()))
    }
}

/// The oracle in a trial.
#[derive(Clone)]
pub struct Oracle {
    options: OracleOptions,
    onwards: Option<Arc<dyn Policy>>,
}

impl Oracle {
    /// An oracle with these options; `onwards` decides the rest of the trial, if the horizon is the trial.
    #[must_use]
    pub fn new(options: OracleOptions, onwards: Option<Arc<dyn Policy>>) -> Self {
        Self { options, onwards }
    }
}

impl Decider for Oracle {
    fn decide(&self, trial: &Simulation, question: &Question) -> Result<Decision, PolicyError> {
        let refused = |error: &dyn std::fmt::Display| PolicyError::Other(format!("ORACLE: {error}"));
        let tasks = task_names(trial.scenario());
        let objective = Objective::parse(&self.options.metric, &tasks).map_err(|error| refused(&error))?;
        let (start, halt) = (trial.checkpoint(), AtomicBool::new(false));
        let outcome = |assignment: &Assignment| {
            let decision = Decision::of(assignment.clone());
            play(&start, decision, self.onwards.as_deref(), &halt)
        };
        let survey = survey(question, (&objective, self.options.limit), &[], |batch| {
            batch.iter().map(outcome).collect::<Result<Vec<_>, BranchError>>()
        });
        let survey = survey.map_err(|error| refused(&error))?;
        let ranked = survey.ranked(&objective);
        let best = ranked.first().or(survey.evaluations.first().as_ref()).copied();
        let best = best.ok_or_else(|| refused(&"there is no assignment"))?;
        let value =
            |outcome| objective.value(outcome).map_or("undefined".to_owned(), |value| format!("{value}"));
        let account = format!(
            "played {} assignments to the end of the {}: {objective} {}",
            survey.evaluations.len(),
            if self.onwards.is_some() { "trial" } else { "round" },
            value(&best.outcome)
        );
        let next = ranked.get(1).map(|next| Alternative { assignment: next.assignment.clone(), score: None });
        Ok(Decision {
            proven_optimal: survey.coverage == Coverage::All,
            alternatives: next.into_iter().collect(),
            account: Account::Text(account),
            ..Decision::of(best.assignment.clone())
        })
    }
}
