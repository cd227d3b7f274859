//! Answers in time.

use teaming::{Act, Asked, Deadline, Decision, PolicyError, Session, TrialStart, Turn};

/// A session whose answers are wanted before a deadline.
pub struct InTime<'d, S> {
    deadline: Deadline<'d>,
    session: S,
}

impl<'d, S: Session> InTime<'d, S> {
    /// The session before this deadline.
    pub fn new(session: S, deadline: Deadline<'d>) -> Self {
        Self { deadline, session }
    }
}

impl<S: Session> Session for InTime<'_, S> {
    fn reset(&mut self, trial: &TrialStart<'_>) -> Result<(), PolicyError> {
        self.session.reset(trial)
    }

    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        self.session.decide(&asked.until(self.deadline))
    }

    fn act(&mut self, turns: &[Turn], base: &Asked<'_>) -> Result<Vec<Act>, PolicyError> {
        self.session.act(turns, &base.until(self.deadline))
    }
}
