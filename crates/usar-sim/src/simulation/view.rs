//! What can be seen of a trial from outside.

use scenario::Scenario;
use teaming::{Question, TaskId};

use super::{Simulation, State};
use crate::belief::{Belief, Beliefs, Holder};
use crate::conflict::Delay;
use crate::event::Event;
use crate::ids::RobotId;
use crate::metrics::Metrics;
use crate::mission::Mission;
use crate::model::{Layout, Model};
use crate::navigation::Navigator;
use crate::record::{DecisionRecord, HeardRecord, whole_question};
use crate::tally::Tally;
use crate::world::World;

impl Simulation {
    /// The question of a decision of this trial as it was asked, with its history and its evidence.
    pub fn question_of(&self, made: &DecisionRecord) -> Question {
        let State { beliefs, telemetry, .. } = self.state();
        let heard = telemetry.as_ref().map(|telemetry| HeardRecord::of(telemetry, self.model()));
        whole_question(made, beliefs.ledger.rounds(), heard.as_ref())
    }

    /// The fixed part of this trial.
    pub fn model(&self) -> &Model {
        &self.setup.model
    }

    /// The scenario, with the values drawn from its distributions for this trial.
    pub fn scenario(&self) -> &Scenario {
        &self.setup.scenario
    }

    /// The scenario as it was given, with its distributions.
    pub fn given(&self) -> &Scenario {
        self.setup.given()
    }

    /// What was drawn from the seed.
    pub fn layout(&self) -> &Layout {
        &self.setup.layout
    }

    /// Seed of the trial.
    pub fn seed(&self) -> u64 {
        self.model().seed
    }

    /// Steps done.
    pub fn steps(&self) -> u64 {
        self.state.step
    }

    /// Simulated time, in seconds.
    pub fn time_s(&self) -> f64 {
        self.state.step as f64 * self.model().dt_s()
    }

    /// The world as it is now.
    pub fn world(&self) -> &World {
        &self.state.world
    }

    /// Mutable access to the world, for tests that inject faults. The next step starts from the changed
    /// world; robots notice at its end what was changed of themselves.
    pub fn world_mut(&mut self) -> &mut World {
        &mut self.state.world
    }

    /// The mission as it is now.
    pub fn mission(&self) -> &Mission {
        &self.state.mission
    }

    /// The beliefs of the groups and of the team at home as they are now.
    pub fn beliefs(&self) -> &Beliefs {
        &self.state.beliefs
    }

    /// The beliefs of the members of a task's group, each once, or that of the team at home.
    pub fn beliefs_of(&self, group: Option<TaskId>) -> impl Iterator<Item = &Belief> {
        let sharing = self.model().mission.belief_sharing;
        let members = group.map_or(&[][..], |task| &self.mission().crew.groups[task.index()].members);
        let in_field =
            group.into_iter().flat_map(move |task| Holder::all_in(sharing, task, members).map(Some));
        let at_home = group.is_none().then_some(None);
        at_home.into_iter().chain(in_field).map(|holder| self.beliefs().of(holder))
    }

    /// The journeys of the robots as they are now.
    pub fn navigator(&self) -> &Navigator {
        &self.state.navigator
    }

    /// The metrics so far.
    pub fn metrics(&self) -> &Metrics {
        &self.state.listeners.metrics
    }

    /// The groupings so far.
    pub fn decisions(&self) -> &[DecisionRecord] {
        &self.state.listeners.decisions
    }

    /// The delay of each robot, by id.
    pub fn delays(&self) -> impl Iterator<Item = Delay> + '_ {
        self.state.listeners.metrics.robots.iter().map(Tally::delay)
    }

    /// The delay of a robot.
    pub fn delay(&self, robot: RobotId) -> Delay {
        self.state.listeners.metrics.robots[robot.index()].delay()
    }

    /// The conflict sets of the last step: ids of their members, in order of precedence. The reciprocal rule
    /// forms no sets.
    pub fn conflict_sets(&self) -> impl Iterator<Item = &[usize]> {
        self.state.resolver.sets()
    }

    /// The events of the last step.
    pub fn events(&self) -> &[Event] {
        self.state.log.events()
    }
}
