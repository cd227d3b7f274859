//! One trial: a scenario and a seed in, a record out, and one interface for decisions.
//!
//! [`Simulation::advance`] does a step, or returns the [question](Advance::Asks) how the team is to be
//! grouped, or the [turns](Ask::Turns) of robots that decide. [`Simulation::assign`] and [`Simulation::act`]
//! take the answers. Policies, programs and people all are [sessions](Session) at this door.

mod charge;
mod checkpoint;
mod faults;
mod in_time;
mod moments;
mod radio;
mod rescue;
mod setup;
mod state;
mod timeline;
mod turns;
mod view;

use std::ops::Deref;
use std::sync::Arc;

use parry2d::math::Vector;
use teaming::{Asked, AssignmentError, Decision, Member, PolicyError, Question, Session, Turn};
use thiserror::Error;

use crate::event::Event;
use crate::ids::RobotId;
use crate::invariant::{Invariants, Overlaps};
use crate::mission::Ending;
use crate::record::{DecisionRecord, HeardRecord, Join, RobotRecord, Status, TaskRecord, TrialRecord};
use crate::stage::Stage;
use crate::world::World;
use scenario::{LayoutError, Scenario};

pub use checkpoint::Checkpoint;
pub use in_time::InTime;
use setup::Setup;
pub(crate) use state::State;
use state::{Listeners, Scratch};

/// A running trial.
pub struct Simulation {
    setup: Arc<Setup>,
    state: State,
    scratch: Scratch,
    /// The question that waits for an answer, with its history.
    question: Option<Question>,
    /// The robots whose turn it is, where robots decide.
    turns: Vec<Turn>,
    failure: Option<String>,
    invariants: Option<Invariants>,
}

/// The result of an advance.
#[derive(Debug)]
pub enum Advance<'s> {
    /// A step was done.
    Running,
    /// A step was begun. It continues once this is answered.
    Asks(Ask<'s>),
    /// The trial is over.
    Over(Status),
}

/// What a trial asks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ask<'s> {
    /// How is the team to be grouped? Answered by [`Simulation::assign`].
    Grouping(&'s Question),
    /// What do these robots do, each of which decides for itself? In the order of their ids. Answered by
    /// [`Simulation::act`]; or by [`Simulation::assign`], which decides over their heads.
    Turns(&'s [Turn]),
}

impl Ask<'_> {
    /// The round about which is asked.
    #[must_use]
    pub fn round(&self) -> u32 {
        match self {
            Self::Grouping(question) => question.round,
            Self::Turns(turns) => turns.first().map_or(0, |turn| turn.question.round),
        }
    }
}

/// An answer that is refused. The question still waits.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum AssignError {
    /// No question waits for an answer.
    #[error("no question waits for an answer")]
    NotAsked,
    /// Only robots that cannot carry are sent out, so that the round would be over at once.
    #[error("an assignment must send out a robot that can carry, if there is one")]
    NobodyCarries,
    /// The assignment does not answer the question.
    #[error(transparent)]
    Refused(#[from] AssignmentError),
    /// What a robot does cannot be done.
    #[error("robot {robot}: {field} must {rule}")]
    Act {
        /// The robot.
        robot: u32,
        /// The field of its act.
        field: &'static str,
        /// What the field must be, and what was found.
        rule: String,
    },
}

impl Simulation {
    /// Draws the layout and builds the world.
    ///
    /// # Errors
    /// The layout cannot be drawn.
    pub fn new(scenario: &Scenario, seed: u64) -> Result<Self, LayoutError> {
        let setup = Setup::new(scenario, seed)?;
        let state = State::new(&setup.model);
        Ok(Self::at(setup, state))
    }

    /// A trial in this state, with nothing asked, failed or checked yet.
    fn at(setup: Arc<Setup>, state: State) -> Self {
        let scratch = Scratch::default();
        Self { setup, state, scratch, question: None, turns: Vec::new(), failure: None, invariants: None }
    }

    /// The trial of this scenario and seed that resumes from this state.
    pub(crate) fn resume(scenario: &Scenario, seed: u64, state: State) -> Result<Self, LayoutError> {
        Ok(Self::from_state(Setup::new(scenario, seed)?, state))
    }

    /// A trial that resumes from this state.
    fn from_state(setup: Arc<Setup>, mut state: State) -> Self {
        state.restore(&setup.model);
        let mut simulation = Self::at(setup, state);
        simulation.take_question();
        simulation
    }

    /// The same trial with every invariant checked at every step. A violation ends the trial as failed.
    #[must_use]
    pub fn checked(mut self) -> Self {
        self.invariants = Some(Invariants::new(self.model(), &self.state.world));
        self
    }

    /// The same trial, with the work of a step divided over all threads where the team is large (500 robots).
    /// The result is the same bit for bit.
    #[must_use]
    pub fn in_parallel(mut self) -> Self {
        self.scratch.use_all_threads();
        self
    }

    /// From now on, robots wish these velocities, by id, in metres a second and up to their top speeds,
    /// instead of those along their routes (`None`). The right of way applies to them as the scenario says.
    /// Wishes are no part of the state: a trial that resumes from a checkpoint or a snapshot goes along
    /// routes.
    pub fn steer(&mut self, velocities: Option<Vec<Vector>>) {
        self.scratch.steering = velocities;
    }

    /// The question that waits for an answer. Where robots decide, it is that of the base, which nobody has
    /// to answer.
    pub fn question(&self) -> Option<&Question> {
        self.question.as_ref()
    }

    /// How deep bodies have overlapped so far, in a checked trial.
    pub fn overlaps(&self) -> Option<Overlaps> {
        self.invariants.as_ref().map(Invariants::overlaps)
    }

    /// Does the next step, or the rest of a step whose question was answered.
    pub fn advance(&mut self) -> Advance<'_> {
        self.advance_watched(&mut |_| {})
    }

    fn advance_watched(&mut self, done: &mut impl FnMut(Stage)) -> Advance<'_> {
        if let Some(status) = self.ending() {
            return Advance::Over(status);
        }
        if !self.state.is_midway {
            self.begin_step(done);
        }
        if self.question.is_some() {
            return self.asks();
        }
        match self.finish_step(done) {
            Ok(()) => Advance::Running,
            Err(reason) => {
                self.failure = Some(reason.clone());
                Advance::Over(Status::Failed(reason))
            }
        }
    }

    fn asks(&self) -> Advance<'_> {
        let Self { question: Some(question), turns, .. } = self else { return Advance::Running };
        Advance::Asks(if turns.is_empty() { Ask::Grouping(question) } else { Ask::Turns(turns) })
    }

    /// Answers the question that [`Simulation::advance`] asked.
    ///
    /// # Errors
    /// Nothing was asked, or the decision does not answer the question; nothing changes then.
    pub fn assign(&mut self, mut decision: Decision) -> Result<(), AssignError> {
        let question = self.question.as_ref().ok_or(AssignError::NotAsked)?;
        // A hand-made decision may name the members of a group in any order.
        decision.assignment = decision.assignment.sorted();
        decision.assignment.check(question)?;
        let can_carry = |id: &u32| self.model().robots[*id as usize].can_carry();
        let idle_carrier = decision.assignment.idle.iter().any(can_carry);
        if idle_carrier && !decision.assignment.groups.iter().flatten().any(can_carry) {
            return Err(AssignError::NobodyCarries);
        }
        self.group(decision, Vec::new());
        Ok(())
    }

    /// Sends the groups out, and keeps the decision.
    fn group(&mut self, decision: Decision, joins: Vec<Join>) {
        let truth = self.truth();
        let (mission, mut scene) = self.state.scene(&self.setup.model);
        mission.assign(&decision.assignment, &joins, &mut scene);
        self.turns.clear();
        if let Some(question) = self.question.take() {
            let question = Question { history: Vec::new(), evidence: None, ..question };
            self.state.listeners.decisions.push(DecisionRecord { question, decision, truth, joins });
        }
    }

    /// The members of the question that waits as they really are; none if the question has them so.
    pub fn truth(&self) -> Option<Vec<Member>> {
        let asked = &self.question.as_ref()?.members;
        Some(self.team()).filter(|team| team != asked)
    }

    /// The members of the question that waits as they really are, by id.
    pub fn team(&self) -> Vec<Member> {
        let (robots, needs) = (&self.state.world.robots, &self.model().needs);
        let asked = self.question.iter().flat_map(|question| &question.members);
        asked.filter_map(|member| robots[member.id as usize].member(needs)).collect()
    }

    /// Does a whole step, in which a session answers questions. Returns the status once the trial is over.
    pub fn step(&mut self, session: impl Session) -> Option<Status> {
        self.watch(session, |_| {})
    }

    /// A [step](Self::step) that reports the end of each of its stages, to measure them.
    pub fn watch(&mut self, mut session: impl Session, mut done: impl FnMut(Stage)) -> Option<Status> {
        loop {
            match self.advance_watched(&mut done) {
                Advance::Running => return None,
                Advance::Over(status) => return Some(status),
                Advance::Asks(_) => self.answer(&mut session),
            }
        }
    }

    /// Lets a session answer what is asked. Without a usable answer, the trial has failed.
    fn answer(&mut self, session: &mut impl Session) {
        let (team, Some(question)) = (self.team(), &self.question) else { return };
        let asked = Asked::of(question).knowing(&team);
        let reason = |error: PolicyError| error.to_string();
        let taken = if self.turns.is_empty() {
            let decision = session.decide(&asked.within(self)).map_err(reason);
            decision.and_then(|decision| self.assign(decision).map_err(|error| error.to_string()))
        } else {
            // A robot that decides for itself cannot play the trial on.
            let acts = session.act(&self.turns, &asked).map_err(reason);
            let round = question.round;
            acts.and_then(|acts| self.act(acts).map_err(|error| format!("round {round}: {error}")))
        };
        if let Err(reason) = taken {
            self.failure = Some(format!("the policy failed: {reason}"));
        }
    }

    /// Runs the trial to its end. `listen` receives the events of each step, with the time in seconds and the
    /// world at that time.
    pub fn run(
        mut self,
        mut session: impl Session,
        mut listen: impl FnMut(f64, &[Event], &World),
    ) -> TrialRecord {
        while self.step(&mut session).is_none() {
            listen(self.time_s(), self.events(), self.world());
        }
        self.finish()
    }

    /// How the trial ended, once it is over.
    pub fn ending(&self) -> Option<Status> {
        if let Some(reason) = &self.failure {
            return Some(Status::Failed(reason.clone()));
        }
        if self.state.is_midway {
            return None;
        }
        match self.state.mission.ending {
            Some(Ending::NobodyCanCarry) => Some(Status::NobodyCanCarry),
            Some(Ending::Finished) => Some(Status::Finished),
            Some(Ending::Standstill) => Some(Status::Stalled),
            None => (self.state.step >= self.model().steps).then_some(Status::Completed),
        }
    }

    /// The record of the trial as far as it was run.
    pub fn finish(mut self) -> TrialRecord {
        let status = self.ending();
        let status = status.unwrap_or_else(|| Status::Failed("it was not run to its end".to_owned()));
        self.state.add_link();
        let (time_s, overlaps, model) = (self.time_s(), self.overlaps(), &self.setup.model);
        let State { world, listeners, chain, beliefs, mission, telemetry, .. } = self.state;
        let Listeners { metrics, decisions } = listeners;
        let robots = world.robots.iter().zip(&metrics.robots);
        let tasks = model.tasks.iter().zip(&metrics.tasks);
        TrialRecord {
            seed: model.seed,
            status,
            time_s,
            tasks: tasks
                .map(|(task, totals)| TaskRecord { task: task.asked.name.clone(), totals: *totals })
                .collect(),
            people: model.rescuees.len() as u32,
            delivered_s: metrics.delivered_s,
            ungrouped_energy: metrics.ungrouped[0],
            ungrouped_hp: metrics.ungrouped[1],
            completed_rounds: metrics.completed_rounds,
            ledger: beliefs.ledger.rounds().to_vec(),
            heard: telemetry.map(|telemetry| HeardRecord::of(&telemetry, model)),
            decisions,
            robots: robots.map(|(robot, tally)| RobotRecord::of(robot, tally, model)).collect(),
            counts: metrics.counts,
            finds: metrics.finds,
            stalled: mission.crew.stalled(world.robots.iter().map(Deref::deref), model),
            cut_off: metrics.cut_off,
            overlaps,
            state_hash: chain.digest(),
            chain,
            rounds: metrics.rounds,
        }
    }

    pub(crate) fn state(&self) -> &State {
        &self.state
    }

    #[cfg(test)]
    pub(crate) fn state_mut(&mut self) -> &mut State {
        &mut self.state
    }

    /// The first part of a step. In a control step robots sense, and a question may arise.
    fn begin_step(&mut self, done: &mut impl FnMut(Stage)) {
        let (state, model) = (&mut self.state, &self.setup.model);
        state.log.clear();
        state.happen(model);
        state.is_midway = true;
        if !model.is_control_step(state.step) {
            return;
        }
        state.sense(model, &mut self.scratch.heard);
        if state.telemetry.is_some() {
            state.report(model);
            state.make_up_rescuees(model);
        }
        done(Stage::Sense);
        state.prepare(model);
        self.take_question();
    }

    /// The rest of a step. In a control step all robots decide from the same snapshot, claims on rescuees
    /// included; in another one, robots that are close to others adapt their velocities. Then all act.
    fn finish_step(&mut self, done: &mut impl FnMut(Stage)) -> Result<(), String> {
        let (state, model, scratch) = (&mut self.state, &self.setup.model, &mut self.scratch);
        let is_control_step = model.is_control_step(state.step);
        if is_control_step {
            let (mission, mut scene) = state.scene(model);
            mission.act(&mut scene);
            done(Stage::Mission);
        }
        let decided = state.listen(0, model.dt_s());
        if is_control_step {
            state.plan(model, scratch);
            done(Stage::Plan);
            state.resolve(model, scratch);
        } else {
            state.adapt(scratch);
        }
        done(Stage::Resolve);
        state.drive();
        done(Stage::Drive);
        state.step += 1;
        state.world.integrate(state.step);
        state.is_midway = false;
        done(Stage::Integrate);
        state.expose(model);
        done(Stage::Exposure);
        if model.is_control_step(state.step) {
            state.rescue(model, &mut scratch.heard);
        }
        done(Stage::Rescue);
        state.listen(decided, model.dt_s());
        if state.step.is_multiple_of(model.link_steps) {
            state.add_link();
        }
        self.check()?;
        done(Stage::Record);
        Ok(())
    }

    /// Takes the mission's questions, if it has any, and adds the history of earlier rounds. Robots that have
    /// all decided go.
    fn take_question(&mut self) {
        let mission = &self.state.mission;
        self.question = mission.question().map(|question| self.whole(question));
        self.turns = self.due();
        if let Some(joined) = mission.agreed() {
            self.depart(joined);
        }
    }

    /// A question with the history and the evidence of who asks it.
    fn whole(&self, question: &Question) -> Question {
        let State { telemetry, beliefs, .. } = &self.state;
        let asker = question.asker.map(RobotId);
        let rounds = || beliefs.ledger.rounds().to_vec();
        let history = telemetry.as_ref().map_or_else(rounds, |telemetry| telemetry.history(asker));
        let evidence = telemetry.as_ref().and_then(|telemetry| telemetry.evidence(asker, self.model()));
        Question { history, evidence, ..question.clone() }
    }

    fn check(&mut self) -> Result<(), String> {
        let time_s = self.time_s();
        let State { log, world, .. } = &self.state;
        if let Some(invariants) = &mut self.invariants {
            invariants.listen(time_s, log.events(), world).map_err(|broken| broken.to_string())?;
            let broken = |what| format!("invariant violated at {time_s:.2} s: {what}");
            self.state.check_costs().map_err(broken)?;
        }
        if world.physics.is_broken() {
            return Err(format!("the physics broke down at {time_s:.2} s: a body's state is not finite"));
        }
        Ok(())
    }
}
