//! The one door for decisions. A [`Driver`] opens a [`Session`] for each worker that runs trials, and the
//! session answers what the trials ask. Every [`Policy`] is a driver. Others start a program, ask a person,
//! or play the trial on.

use std::any::Any;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::decision::Decision;
use crate::error::PolicyError;
use crate::policy::Policy;
use crate::protocol::{Act, Turn, Undecided};
use crate::question::{Member, Question};
use crate::truth::Truth;

/// Something that answers questions, before it is asked any.
pub trait Driver: Send + Sync {
    /// Opens a session. Workers open one each and keep it over their trials.
    ///
    /// # Errors
    /// The session cannot be opened.
    fn open(&self) -> Result<Box<dyn Session>, PolicyError>;

    /// What its answers follow from.
    fn basis(&self) -> Basis {
        Basis::Question
    }

    /// Whether it is told what is true. A policy of a team that only hears of its robots is not.
    fn needs_truth(&self) -> bool {
        false
    }

    /// Whether it answers only in the running trial that asks.
    fn needs_trial(&self) -> bool {
        false
    }

    /// Whether it leaves robots idle, so that it answers only questions that allow it.
    fn leaves_idle(&self) -> bool {
        false
    }

    /// The least number of raters that each robot must have for its estimator to hold what it promises.
    fn least_raters(&self) -> Option<u32> {
        None
    }

    /// What of it does nothing, in a sentence.
    fn idle_part(&self) -> Option<String> {
        None
    }

    /// A text that changes whenever its answers may change. Results are kept as long as it stays. `None` is
    /// for a driver that is known by the program that has it, see `from_sources` of its kind.
    fn fingerprint(&self) -> Option<String> {
        None
    }

    /// The same driver under the label that it has in tables. `None` for a driver to which that is nothing.
    fn labelled(&self, _label: &str) -> Option<Arc<dyn Driver>> {
        None
    }

    /// The command of the program that it starts. `None` for a driver that starts none.
    fn program(&self) -> Option<String> {
        None
    }

    /// Whether it may be asked. A driver that starts a program is permitted by a person.
    ///
    /// # Errors
    /// Nobody has allowed the program.
    fn permission(&self) -> Result<(), PolicyError> {
        Ok(())
    }

    /// Why it will not answer any more, so that no further trial should begin. `None` as long as it may.
    fn gave_up(&self) -> Option<String> {
        None
    }
}

/// What the answers of a driver follow from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Basis {
    /// The question alone. Trials whose questions get the same answers are run once.
    Question,
    /// The running trial as well: without one there is no answer.
    Trial,
    /// Nothing here: the driver stands for one of another program, and never answers.
    Absent,
    /// Luck or a person: the same question may get another answer. Such a driver shares no trials, and its
    /// results cannot be verified.
    Undetermined,
}

/// A driver at work.
pub trait Session: Send {
    /// Begins a trial, or goes on with one from any of its rounds: what went before is in the history of each
    /// question. All questions up to the next call are of this trial.
    ///
    /// # Errors
    /// The session cannot go on.
    fn reset(&mut self, _trial: &TrialStart<'_>) -> Result<(), PolicyError> {
        Ok(())
    }

    /// Answers a question.
    ///
    /// # Errors
    /// The question cannot be answered, or not before the deadline.
    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError>;

    /// Lets robots that decide for themselves act, each in its turn, in the order of their ids. `base` is
    /// what the base would be asked. Without a protocol, each decides at once, alone.
    ///
    /// # Errors
    /// A robot cannot act, or not before the deadline.
    fn act(&mut self, turns: &[Turn], base: &Asked<'_>) -> Result<Vec<Act>, PolicyError> {
        each_alone(self, turns, base)
    }
}

/// Each robot joins the group in which its own decision has it. One that is out of time may have to do as the
/// base says, whose question `base` is.
///
/// # Errors
/// Those of [`Session::decide`].
pub fn each_alone(
    session: &mut (impl Session + ?Sized),
    turns: &[Turn],
    base: &Asked<'_>,
) -> Result<Vec<Act>, PolicyError> {
    let mut of_base = None;
    let mut act = |turn: &Turn| {
        let decision = match turn.late {
            Some(Undecided::Stays) => return Ok(Act::default()),
            Some(Undecided::Base) => match &of_base {
                Some(decision) => Decision::clone(decision),
                None => of_base.insert(session.decide(base)?).clone(),
            },
            Some(Undecided::OwnView) | None => session.decide(&base.about(&turn.question))?,
        };
        Ok(Act::joins(decision.assignment))
    };
    turns.iter().map(&mut act).collect()
}

/// A trial that begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TrialStart<'a> {
    /// Name of the scenario.
    pub scenario: &'a str,
    /// Number of the trial, by which a session can tell trials apart. Its seed does not follow from it.
    pub number: u64,
}

/// A question, and who asks it.
#[derive(Clone, Copy)]
pub struct Asked<'a> {
    /// The question.
    pub question: &'a Question,
    /// When it is too late to answer.
    pub deadline: Deadline<'a>,
    truth: Option<Truth<'a>>,
    trial: Option<&'a dyn Any>,
    /// Whether a driver has declared which of the two it needs.
    is_declared: bool,
}

impl<'a> Asked<'a> {
    /// A question that is asked outside of a trial and without a deadline.
    #[must_use]
    pub fn of(question: &'a Question) -> Self {
        Self { question, deadline: Deadline::NEVER, truth: None, trial: None, is_declared: false }
    }

    /// The same, by someone who knows how the members really are.
    #[must_use]
    pub fn knowing(self, team: &'a [Member]) -> Self {
        Self { truth: Some(Truth(team)), ..self }
    }

    /// The same, in a running trial.
    #[must_use]
    pub fn within(self, trial: &'a dyn Any) -> Self {
        Self { trial: Some(trial), ..self }
    }

    /// Another question at the same moment.
    pub(crate) fn about<'q>(&self, question: &'q Question) -> Asked<'q>
    where
        'a: 'q,
    {
        Asked { question, ..*self }
    }

    /// The same, to be answered before this deadline.
    #[must_use]
    pub fn until(self, deadline: Deadline<'a>) -> Self {
        Self { deadline, ..self }
    }

    /// What is true, for a session of a driver that [needs the truth](Driver::needs_truth). No other gets it.
    #[must_use]
    pub fn truth(&self) -> Option<Truth<'a>> {
        self.truth.filter(|_| self.is_declared)
    }

    /// The running trial, for a session of a driver that [needs it](Driver::needs_trial), to play it on. No
    /// other gets it.
    #[must_use]
    pub fn trial(&self) -> Option<&'a dyn Any> {
        self.trial.filter(|_| self.is_declared)
    }
}

/// The moment after which an answer is not wanted any more. Whoever measures the time raises a flag then; a
/// session that takes long looks at it and gives up with [`PolicyError::Late`].
#[derive(Debug, Clone, Copy)]
pub struct Deadline<'a>(Option<&'a AtomicBool>);

impl<'a> Deadline<'a> {
    /// No deadline.
    pub const NEVER: Self = Self(None);

    /// The moment at which this flag is raised.
    #[must_use]
    pub fn when(flag: &'a AtomicBool) -> Self {
        Self(Some(flag))
    }

    /// Whether it is too late.
    #[must_use]
    pub fn is_over(self) -> bool {
        self.0.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    /// Goes on unless it is too late.
    ///
    /// # Errors
    /// [`PolicyError::Late`].
    pub fn check(self) -> Result<(), PolicyError> {
        if self.is_over() { Err(PolicyError::Late) } else { Ok(()) }
    }
}

/// A policy of another program, by its name.
pub(crate) struct Absent(pub(crate) String);

impl Driver for Absent {
    fn open(&self) -> Result<Box<dyn Session>, PolicyError> {
        Err(PolicyError::Absent { policy: self.0.clone() })
    }

    fn basis(&self) -> Basis {
        Basis::Absent
    }

    fn fingerprint(&self) -> Option<String> {
        Some(String::new())
    }
}

/// A policy is a session of its own: it keeps nothing between questions.
impl<P: Policy + ?Sized> Session for &P {
    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        Policy::decide(*self, asked.question)
    }
}

impl<S: Session + ?Sized> Session for &mut S {
    fn reset(&mut self, trial: &TrialStart<'_>) -> Result<(), PolicyError> {
        (**self).reset(trial)
    }

    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        (**self).decide(asked)
    }

    fn act(&mut self, turns: &[Turn], base: &Asked<'_>) -> Result<Vec<Act>, PolicyError> {
        (**self).act(turns, base)
    }
}

/// A session that gets of the truth and of the trial what its driver has declared.
pub(crate) struct Declared {
    it: Box<dyn Session>,
    needs_truth: bool,
    needs_trial: bool,
}

impl Declared {
    /// Opens a session of a driver.
    pub(crate) fn open(driver: &dyn Driver) -> Result<Self, PolicyError> {
        let (needs_truth, needs_trial) = (driver.needs_truth(), driver.needs_trial());
        Ok(Self { it: driver.open()?, needs_truth, needs_trial })
    }

    fn declared<'a>(&self, asked: &Asked<'a>) -> Asked<'a> {
        let truth = asked.truth.filter(|_| self.needs_truth);
        let trial = asked.trial.filter(|_| self.needs_trial);
        Asked { truth, trial, is_declared: true, ..*asked }
    }
}

impl Session for Declared {
    fn reset(&mut self, trial: &TrialStart<'_>) -> Result<(), PolicyError> {
        self.it.reset(trial)
    }

    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        let declared = self.declared(asked);
        self.it.decide(&declared)
    }

    fn act(&mut self, turns: &[Turn], base: &Asked<'_>) -> Result<Vec<Act>, PolicyError> {
        let declared = self.declared(base);
        self.it.act(turns, &declared)
    }
}

/// A policy as a driver.
pub(crate) struct Pure<P>(pub Arc<P>);

impl<P: Policy + 'static> Driver for Pure<P> {
    fn open(&self) -> Result<Box<dyn Session>, PolicyError> {
        Ok(Box::new(Self(Arc::clone(&self.0))))
    }
}

impl<P: Policy> Session for Pure<P> {
    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        self.0.decide(asked.question)
    }
}
