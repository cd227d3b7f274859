//! The driver that answers the questions of a sweep's trials.

use std::sync::Arc;

use rne_core::{Decision, Policy, PolicyError, Question};
use usar_sim::simulation::{Decider, Simulation};

use crate::oracle::Oracle;

/// A driver answers the questions of a sweep's trials: a policy, or the oracle.
#[derive(Clone)]
pub enum Driver {
    /// A policy: a function of the question.
    Policy(Arc<dyn Policy>),
    /// The oracle: it plays in the trial that asks.
    Oracle(Box<Oracle>),
}

impl Driver {
    /// The policy, unless it is the oracle.
    #[must_use]
    pub fn policy(&self) -> Option<&dyn Policy> {
        match self {
            Self::Policy(policy) => Some(&**policy),
            Self::Oracle(_) => None,
        }
    }
}

impl Decider for Driver {
    fn decide(&self, trial: &Simulation, question: &Question) -> Result<Decision, PolicyError> {
        match self {
            Self::Policy(policy) => policy.decide(question),
            Self::Oracle(oracle) => oracle.decide(trial, question),
        }
    }
}
