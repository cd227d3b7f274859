//! `ORACLE`: chooses the assignment with the best outcome, known by playing every assignment. It
//! answers from more than the question, because it sees the trial that asks.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use teaming::{
    Account, Alternative, Asked, Assignment, Basis, Decision, Driver, MadePolicy, PolicyError, PolicyKind,
    Registry, Session,
};
use usar_sim::simulation::Simulation;

use super::branch::{BranchError, play};
use super::objective::Objective;
use super::survey::{Coverage, survey};
use super::{DEFAULT_LIMIT, LIMITS};
use crate::metric::task_names;

/// Name of the oracle among the policies.
const NAME: &str = "ORACLE";

/// How far the oracle looks ahead.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Horizon {
    /// To the end of the round.
    Round,
    /// To the end of the trial. Another policy decides the later rounds.
    Trial,
}

/// Which assignment the oracle chooses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Pick {
    /// The best.
    Best,
    /// The worst, to see how much grouping can matter.
    Worst,
}

teaming::options! {
    /// Options of `ORACLE`.
    #[derive(Eq)]
    pub struct OracleOptions {
        /// The metric that it maximises, or minimises if it is a cost.
        pub metric: String = "rescuees.total".to_owned(),
        /// How far it looks ahead.
        pub horizon: Horizon = Horizon::Round,
        /// The policy that decides after the round, if the horizon is the trial.
        pub then: String = "RNE".to_owned(),
        /// Largest number of assignments that it plays for one decision.
        pub limit: u64 = DEFAULT_LIMIT,
        /// Which assignment it chooses.
        pub pick: Pick = Pick::Best,
    }
}

/// The oracle: a driver whose sessions play in the trial that asks.
pub struct Oracle {
    options: OracleOptions,
    /// Decides the rest of the trial, if the horizon is the trial.
    onwards: Option<MadePolicy>,
}

/// The oracle's entry in a registry.
pub fn kind() -> PolicyKind {
    let about = "the assignment of which most comes in the round, known by playing them all";
    PolicyKind::made(NAME, about, |options: OracleOptions, registry| {
        Oracle::new(options, registry).map(|oracle| Arc::new(oracle) as Arc<dyn Driver>)
    })
}

impl Oracle {
    /// Takes the options; the policy that decides the rest of the trial comes from this registry.
    fn new(options: OracleOptions, registry: &Registry) -> Result<Self, String> {
        if !LIMITS.contains(&options.limit) {
            return Err(format!("limit must be from 2 to 1000000, found {}", options.limit));
        }
        let onwards = (options.horizon == Horizon::Trial).then(|| registry.parse(&options.then));
        let onwards = onwards.transpose().map_err(|error| format!("then: {error}"))?;
        Ok(Self { options, onwards })
    }
}

impl Driver for Oracle {
    fn open(&self) -> Result<Box<dyn Session>, PolicyError> {
        let onwards = self.onwards.as_ref().map(MadePolicy::open).transpose()?;
        Ok(Box::new(OracleSession { options: self.options.clone(), onwards }))
    }

    fn program(&self) -> Option<String> {
        self.onwards.as_ref().and_then(|then| then.it.program())
    }

    fn permission(&self) -> Result<(), PolicyError> {
        self.onwards.as_ref().map_or(Ok(()), |then| then.it.permission())
    }

    fn basis(&self) -> Basis {
        let onwards = self.onwards.as_ref().map(|then| then.it.basis());
        onwards.filter(|basis| *basis == Basis::Undetermined).unwrap_or(Basis::Trial)
    }

    fn needs_trial(&self) -> bool {
        true
    }

    /// The oracle's own sources are those of the laboratory, which decide every trial.
    fn fingerprint(&self) -> Option<String> {
        self.onwards
            .as_ref()
            .map_or(Some("oracle".to_owned()), |then| Some(format!("oracle {}", then.fingerprint()?)))
    }
}

/// The oracle at work.
struct OracleSession {
    options: OracleOptions,
    onwards: Option<Box<dyn Session>>,
}

impl Session for OracleSession {
    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        let Asked { question, deadline, .. } = *asked;
        let Some(trial) = asked.trial().and_then(|trial| trial.downcast_ref::<Simulation>()) else {
            return Err(PolicyError::NoTrial { policy: NAME.to_owned() });
        };
        let refused = |error: &dyn std::fmt::Display| PolicyError::Other(format!("{NAME}: {error}"));
        let tasks = task_names(trial.scenario());
        let objective = Objective::parse(&self.options.metric, &tasks).map_err(|error| refused(&error))?;
        let objective = if self.options.pick == Pick::Best { objective } else { objective.opposite() };
        let (start, onwards) = (trial.checkpoint(), &mut self.onwards);
        let horizon = if onwards.is_some() { "trial" } else { "round" };
        let survey = survey(question, &objective, self.options.limit, &[], |batch| {
            let outcome = |assignment: &Assignment| {
                play(&start, Decision::of(assignment.clone()), onwards.as_mut(), deadline)
            };
            batch.iter().map(outcome).collect::<Result<Vec<_>, BranchError>>()
        });
        deadline.check()?;
        let survey = survey.map_err(|error| refused(&error))?;
        let ranked = survey.ranked(&objective);
        let best = ranked.first().or(survey.evaluations.first().as_ref()).copied();
        let best = best.ok_or_else(|| refused(&"there is no assignment"))?;
        let value =
            |outcome| objective.value(outcome).map_or("undefined".to_owned(), |value| format!("{value}"));
        let account = format!(
            "played {} assignments to the end of the {}: {objective} {}",
            survey.evaluations.len(),
            horizon,
            value(&best.outcome)
        );
        let next = ranked.get(1).map(|next| Alternative { assignment: next.assignment.clone(), score: None });
        Ok(Decision {
            believed: None,
            proven_optimal: survey.coverage == Coverage::All,
            alternatives: next.into_iter().collect(),
            account: Account::Text(account),
            ..Decision::of(best.assignment.clone())
        })
    }
}
