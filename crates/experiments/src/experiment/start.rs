//! What is tried before the first trial of a sweep.

use std::fmt::Display;
use std::path::Path;

use scenario::seed::trial_number;
use store::Failure;
use teaming::{Act, Asked, Assignment, Basis, PolicyError, Session, TrialStart, Turn};
use usar_sim::simulation::{Advance, Ask, Simulation};

use super::{Case, Experiment, PolicySpec};
use crate::run::{Player, Sessions};

impl Experiment {
    /// Draws every layout and asks every policy that is here the first question, and once more in a second
    /// session. A scenario without enough room, a policy that cannot group this team, or one that answers the
    /// same question in two ways then fails before the first trial runs.
    ///
    /// # Errors
    /// A layout that cannot be drawn, a question that a policy cannot answer, or another answer to it, with
    /// the seed.
    pub fn check_start(&self, path: &Path) -> Result<(), Failure> {
        let mut sessions = Sessions::default();
        for (number, case) in self.cases.iter().enumerate() {
            let is_drawn = case.scenario.is_drawn();
            let trials = if is_drawn { self.trials } else { 1 };
            for trial in 1..=trials {
                let seed = self.seed(trial);
                let is_first = number == 0 && trial == 1;
                self.check_case(case, seed, is_first, &mut sessions)
                    .map_err(Failure::input_at(path.display()))?;
            }
        }
        Ok(())
    }

    fn check_case(
        &self,
        case: &Case,
        seed: u64,
        is_first: bool,
        sessions: &mut Sessions,
    ) -> Result<(), String> {
        let place = self.describe(case);
        let mut trial =
            Simulation::new(&case.scenario, seed).map_err(|error| format!("{place}seed {seed}: {error}"))?;
        let turns = match trial.advance() {
            Advance::Asks(Ask::Turns(turns)) => turns.to_vec(),
            _ => Vec::new(),
        };
        let (Some(question), team) = (trial.question(), trial.team()) else { return Ok(()) };
        let asked = Asked::of(question).knowing(&team);
        let start = TrialStart { scenario: &case.scenario.name, number: trial_number(seed) };
        let is_asked = |spec: &PolicySpec| spec.is_of_question() && spec.made().it.basis() != Basis::Absent;
        for (number, spec) in self.policies.iter().enumerate().filter(|(_, spec)| is_asked(spec)) {
            let refused = |error: &dyn Display| format!("{place}seed {seed}: policy {}: {error}", spec.label);
            let Player { session, basis } =
                sessions.of(number, spec.made()).map_err(|error| refused(&error))?;
            let ask = |session: &mut dyn Session| answer(session, &start, &turns, &asked);
            let first = ask(session).map_err(|error| refused(&error))?;
            if let Answer::Groups(groups) = &first {
                groups.check(question).map_err(|error| refused(&error))?;
            }
            if is_first && basis == Basis::Question {
                let second = spec.made().open().and_then(|mut second| ask(&mut *second));
                let second = second.map_err(|error| refused(&error))?;
                if second != first {
                    return Err(refused(&differing(&[first, second])));
                }
            }
        }
        Ok(())
    }
}

/// What is answered to the first question.
#[derive(PartialEq)]
enum Answer {
    /// By the base.
    Groups(Assignment),
    /// By robots that decide for themselves.
    Acts(Vec<Act>),
}

fn answer(
    session: &mut dyn Session,
    start: &TrialStart<'_>,
    turns: &[Turn],
    asked: &Asked<'_>,
) -> Result<Answer, PolicyError> {
    session.reset(start)?;
    if turns.is_empty() {
        return Ok(Answer::Groups(session.decide(asked)?.assignment.sorted()));
    }
    Ok(Answer::Acts(session.act(turns, asked)?))
}

fn differing(answers: &[Answer; 2]) -> String {
    let [first, second] = answers.each_ref().map(|answer| match answer {
        Answer::Groups(assignment) => format!("{:?}", assignment.groups),
        Answer::Acts(acts) => format!("{acts:?}"),
    });
    format!(
        "it is no function of its question: asked the first question in two sessions, it answers {first} and \
         {second}. A policy may use nothing but the question: no clock, no random numbers of its own, no \
         order of a hash table. A program for which that cannot be writes \"deterministic\": false in its \
         hello"
    )
}
