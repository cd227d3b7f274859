//! One trial: a scenario, a policy and a seed in; a record out.

mod state;

use rne_core::GroupingPolicy;

use crate::conflict::{Delay, Mover, Resolver};
use crate::event::{Event, EventLog};
use crate::hash::{HashChain, PERIOD_STEPS};
use crate::invariant::{Invariants, Overlaps};
use crate::layout::Layout;
use crate::metrics::Metrics;
use crate::mission::{Ending, Mission};
use crate::planning::Navigator;
use crate::record::{Status, TrialRecord};
use crate::scenario::{LayoutError, Scenario};
use crate::stage::Stage;
use crate::tally::Tally;
use crate::world::World;

pub(crate) use state::State;

/// A running trial.
pub struct Simulation<'a> {
    scenario: &'a Scenario,
    policy: &'a dyn GroupingPolicy,
    seed: u64,
    state: State,
    invariants: Option<Invariants>,
    /// Empty between steps: its memory serves the next step.
    movers: Vec<Mover<'static>>,
}

impl<'a> Simulation<'a> {
    /// Draws the layout and builds the world.
    ///
    /// # Errors
    /// The layout cannot be drawn.
    pub fn new(
        scenario: &'a Scenario,
        policy: &'a dyn GroupingPolicy,
        seed: u64,
    ) -> Result<Self, LayoutError> {
        let layout = Layout::sample(scenario, seed)?;
        let world = World::build(scenario, &layout);
        let state = State {
            step: 0,
            mission: Mission::new(scenario, &world, seed),
            navigator: Navigator::new(scenario, world.robots.len()),
            resolver: Resolver::new(scenario),
            metrics: Metrics::new(world.robots.len()),
            log: EventLog::default(),
            tallies: layout.robots.iter().map(|start| Tally::new(start.energy, start.hp)).collect(),
            chain: HashChain::default(),
            world,
        };
        Ok(Self { scenario, policy, seed, state, invariants: None, movers: Vec::new() })
    }

    /// A trial that goes on from this state.
    pub(crate) fn from_state(
        scenario: &'a Scenario,
        policy: &'a dyn GroupingPolicy,
        seed: u64,
        mut state: State,
    ) -> Self {
        state.world.restore();
        state.resolver.restore();
        state.mission.restore(&state.world);
        Self { scenario, policy, seed, state, invariants: None, movers: Vec::new() }
    }

    /// The same trial, with every invariant checked at every step: a violation ends it as failed.
    #[must_use]
    pub fn checked(mut self) -> Self {
        self.invariants = Some(Invariants::new(self.scenario, &self.state.world));
        self
    }

    /// How deep bodies have overlapped so far, in a checked trial.
    #[must_use]
    pub fn overlaps(&self) -> Option<Overlaps> {
        self.invariants.as_ref().map(Invariants::overlaps)
    }

    /// Runs to the end. `listen` hears the events of each step, with the time in seconds and the world as it is then.
    pub fn run(mut self, mut listen: impl FnMut(f64, &[Event], &World)) -> TrialRecord {
        let status = loop {
            if let Some(status) = self.ending() {
                break status;
            }
            if let Err(reason) = self.step() {
                break Status::Failed(reason);
            }
            listen(self.time_s(), self.events(), self.world());
        };
        self.into_record(status)
    }

    /// How the trial ended, once it is over.
    #[must_use]
    pub fn ending(&self) -> Option<Status> {
        if let Some(ending) = self.state.mission.ending {
            Some(match ending {
                Ending::NoCarrierLeft => Status::NoCarrierLeft,
                Ending::ErrandsOver => Status::ErrandsOver,
            })
        } else if self.state.step >= self.scenario.steps() {
            Some(Status::Completed)
        } else {
            None
        }
    }

    /// The record of the trial as far as it was run, step by step.
    #[must_use]
    pub fn finish(self) -> TrialRecord {
        let status = self.ending().unwrap_or(Status::Failed("it was not run to its end".to_owned()));
        self.into_record(status)
    }

    /// The scenario.
    #[must_use]
    pub fn scenario(&self) -> &'a Scenario {
        self.scenario
    }

    /// The grouping policy.
    #[must_use]
    pub fn policy(&self) -> &'a dyn GroupingPolicy {
        self.policy
    }

    /// Seed of the trial.
    #[must_use]
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Steps done.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.state.step
    }

    /// Simulated time, in seconds.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.state.step as f64 * self.scenario.dt_s
    }

    /// The world as it is now.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.state.world
    }

    /// The world, to be changed: for tests that seed faults. The next step goes on from what is there.
    pub fn world_mut(&mut self) -> &mut World {
        &mut self.state.world
    }

    /// The mission as it is now.
    #[must_use]
    pub fn mission(&self) -> &Mission {
        &self.state.mission
    }

    /// The journeys of the robots as they are now.
    #[must_use]
    pub fn navigator(&self) -> &Navigator {
        &self.state.navigator
    }

    /// Why each robot does not move on, as far as it does not; by id.
    pub fn delays(&self) -> impl Iterator<Item = Delay> + '_ {
        self.state.tallies.iter().map(Tally::delay)
    }

    /// The events of the last step.
    #[must_use]
    pub fn events(&self) -> &[Event] {
        self.state.log.events()
    }

    pub(crate) fn state(&self) -> &State {
        &self.state
    }

    #[cfg(test)]
    pub(crate) fn state_mut(&mut self) -> &mut State {
        &mut self.state
    }

    /// One step: all robots decide from the same snapshot, then all act.
    ///
    /// # Errors
    /// The policy fails, the physics breaks down, or, in a checked trial, an invariant is violated.
    pub fn step(&mut self) -> Result<(), String> {
        self.step_watched(|_| {})
    }

    /// A step that reports the end of each of its stages, to measure them.
    ///
    /// # Errors
    /// Those of [`Simulation::step`].
    pub fn step_watched(&mut self, mut done: impl FnMut(Stage)) -> Result<(), String> {
        let state = &mut self.state;
        state.log.clear();
        state.mission.sense(&state.world, state.step, &mut state.log);
        done(Stage::Sense);
        state.mission.decide(
            &mut state.world,
            &mut state.navigator,
            self.policy,
            state.step,
            &mut state.log,
        )?;
        done(Stage::Mission);
        let decided = state.listen(0, self.scenario.dt_s);
        state.plan();
        done(Stage::Plan);
        state.resolve(self.scenario, &mut self.movers);
        done(Stage::Resolve);
        state.drive(self.scenario);
        done(Stage::Drive);
        state.world.integrate();
        state.step += 1;
        done(Stage::Integrate);
        state.expose(self.scenario);
        done(Stage::Exposure);
        state.mission.settle(&mut state.world, &state.navigator, state.step, &mut state.log);
        done(Stage::Rescue);
        state.listen(decided, self.scenario.dt_s);
        if state.step.is_multiple_of(PERIOD_STEPS) {
            state.add_link();
        }
        self.check()?;
        done(Stage::Record);
        Ok(())
    }

    fn check(&mut self) -> Result<(), String> {
        let time_s = self.time_s();
        let State { log, world, .. } = &self.state;
        if let Some(invariants) = &mut self.invariants {
            invariants.listen(time_s, log.events(), world).map_err(|broken| broken.to_string())?;
        }
        if world.physics.is_broken() {
            return Err(format!("the physics broke down at {time_s:.2} s: a body's state is not finite"));
        }
        Ok(())
    }

    fn into_record(mut self, status: Status) -> TrialRecord {
        self.state.add_link();
        let time_s = self.time_s();
        let overlaps = self.overlaps();
        let State { world, metrics, tallies, chain, .. } = self.state;
        let robots = world.robots.iter().zip(&tallies);
        TrialRecord {
            policy: self.policy.name().to_owned(),
            seed: self.seed,
            status,
            time_s,
            hard: metrics.tasks[0],
            easy: metrics.tasks[1],
            ungrouped_energy: metrics.ungrouped[0],
            ungrouped_hp: metrics.ungrouped[1],
            completed_rounds: metrics.completed_rounds,
            robots: robots.map(|(robot, tally)| tally.record(robot, self.scenario.dt_s)).collect(),
            turned_back: metrics.turned_back,
            conflicts: metrics.conflicts,
            deadlocks: metrics.deadlocks,
            rotations: metrics.rotations,
            retreats: metrics.retreats,
            back_offs: metrics.back_offs,
            errands_done: metrics.errands_done,
            unreachable: metrics.unreachable,
            overlaps,
            state_hash: chain.digest(),
            chain,
            rounds: metrics.rounds,
        }
    }
}
