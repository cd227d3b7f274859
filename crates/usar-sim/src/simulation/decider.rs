//! The interface for answers to the questions of a trial.

use rne_core::{Decision, Policy, PolicyError, Question};

use super::Simulation;

/// Answers the questions of a trial. Every [`Policy`] is a decider that sees only the question. An oracle
/// also looks at the trial.
pub trait Decider {
    /// Answers the question that the trial asks.
    ///
    /// # Errors
    /// The question cannot be answered; the trial fails then.
    fn decide(&self, trial: &Simulation, question: &Question) -> Result<Decision, PolicyError>;
}

impl<P: Policy + ?Sized> Decider for P {
    fn decide(&self, _trial: &Simulation, question: &Question) -> Result<Decision, PolicyError> {
        Policy::decide(self, question)
    }
}
