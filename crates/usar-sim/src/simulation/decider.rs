//! Answers to the questions of a trial.

use rne_core::{Decision, Policy, PolicyError, Question};

use super::Simulation;

/// Answers the questions of a trial. Every [`Policy`] is a decider that looks at the question alone; an
/// oracle looks at the trial, too.
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
