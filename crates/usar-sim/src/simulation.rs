//! One trial: a scenario, a policy and a seed in; a record out.

use parry2d::math::Vector;
use rne_core::GroupingPolicy;
use serde::{Deserialize, Serialize};

use crate::conflict::{Delay, Mover, PriorityKey, Resolver};
use crate::event::{Event, EventLog};
use crate::hash::{HashChain, PARTS, PERIOD_STEPS, part};
use crate::invariant::{Invariants, Overlaps};
use crate::layout::Layout;
use crate::metrics::Metrics;
use crate::mission::{Activity, Ending, Mission};
use crate::planning::{Navigator, PLANNED_BRAKING};
use crate::record::{Status, TrialRecord};
use crate::scenario::{LayoutError, PriorityRule, Scenario};
use crate::stage::Stage;
use crate::tally::{Tally, delay_cause};
use crate::vitals::{energy_cost, hp_cost};
use crate::world::{Condition, Robot, STANDING_MPS, World};

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

/// All that changes in a trial: what a snapshot holds and what the hash chain covers.
#[derive(Serialize, Deserialize)]
pub(crate) struct State {
    step: u64,
    world: World,
    mission: Mission,
    navigator: Navigator,
    resolver: Resolver,
    metrics: Metrics,
    log: EventLog,
    tallies: Vec<Tally>,
    chain: HashChain,
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

#[cfg(test)]
impl State {
    pub(crate) fn step(&self) -> u64 {
        self.step
    }

    pub(crate) fn chain_mut(&mut self) -> &mut HashChain {
        &mut self.chain
    }
}

impl State {
    /// Lets the metrics hear the events from the `from`-th of this step on; returns how many there are.
    fn listen(&mut self, from: usize, dt_s: f64) -> usize {
        let events = self.log.events();
        self.metrics.listen(&events[from..], &self.world, self.step as f64 * dt_s);
        events.len()
    }

    fn plan(&mut self) {
        let (mission, world) = (&self.mission, &self.world);
        let speed_of = |robot: &Robot| mission.speed_of(robot);
        self.navigator.plan(world, |robot| mission.knowledge_of(robot), speed_of, self.step);
    }

    /// Settles who goes and who waits, and takes note of why robots stop.
    fn resolve(&mut self, scenario: &Scenario, spare: &mut Vec<Mover<'static>>) {
        let rule = scenario.conflicts.priority;
        let seen_by = (&self.mission, &self.navigator);
        let mut movers: Vec<Mover> = std::mem::take(spare);
        movers.extend(self.world.robots.iter().map(|robot| mover(robot, rule, seen_by)));
        let directives = self.resolver.resolve(&mut movers, &mut self.log);
        for ((robot, directive), tally) in self.world.robots.iter().zip(directives).zip(&mut self.tallies) {
            let traveller = self.navigator.traveller(robot.id);
            let activity = self.mission.agents[robot.id.index()].activity;
            let cause = delay_cause(robot, activity, traveller, *directive);
            tally.note_delay(Delay { cause, waits_for: directive.waits_for() }, traveller.stalled_steps());
        }
        movers.clear();
        *spare = movers.into_iter().map(|_| unreachable!("it is empty")).collect(); // the same memory
    }

    /// Lets each drive come as near to what it is told as its force allows.
    fn drive(&mut self, scenario: &Scenario) {
        for (robot, directive) in self.world.robots.iter().zip(self.resolver.directives()) {
            let greatest_change = (robot.spec.acceleration_mps2 * scenario.dt_s) as f32;
            let change = (directive.velocity() - robot.velocity).clamp_length_max(greatest_change);
            self.world.physics.drive(robot.id, change);
        }
    }

    /// Energy for moving, HP for radiation; robots that have none left stay where they are.
    fn expose(&mut self, scenario: &Scenario) {
        let (costs, dt) = (&scenario.costs, scenario.dt_s);
        for (robot, tally) in self.world.robots.iter_mut().zip(&mut self.tallies) {
            let speed = robot.velocity.length();
            let metres = f64::from(speed) * dt;
            tally.note_way(metres);
            let resting = matches!(self.mission.agents[robot.id.index()].activity, Activity::Resting(_));
            if !robot.is_able() || resting {
                continue;
            }
            let zones = self.world.zones.iter().filter(|zone| zone.contains(robot.position)).count();
            let energy = energy_cost(&costs.energy, speed > STANDING_MPS, metres, dt).min(robot.energy);
            let hp = hp_cost(&costs.hp, zones, metres, dt).min(robot.hp);
            robot.energy -= energy;
            robot.hp -= hp;
            tally.note_costs(energy, hp);
            self.metrics.charge(robot.id.index(), energy, hp);
            if robot.energy <= 0.0 {
                robot.condition = Condition::Stranded;
                self.log.push(Event::Stranded { robot: robot.id });
            } else if robot.hp <= 0.0 {
                robot.condition = Condition::Disabled;
                self.log.push(Event::Disabled { robot: robot.id });
            }
        }
    }

    /// Adds a link to the hash chain.
    fn add_link(&mut self) {
        if self.chain.links().last().is_some_and(|link| link.step == self.step) {
            return;
        }
        let parts = self.parts();
        self.chain.add(self.step, parts);
    }

    /// The hash of each part of the state, in the order of [`PARTS`].
    pub(crate) fn parts(&self) -> [u128; PARTS.len()] {
        [
            part(&self.world.physics.motions()),
            part(&self.world.robots),
            part(&(&self.world.debris, &self.world.zones)),
            part(&self.world.rescuees),
            part(self.mission.beliefs()),
            part(&self.mission.course()),
            part(&self.navigator),
            part(&self.resolver),
            part(&(&self.metrics, &self.tallies)),
            part(&self.log),
        ]
    }
}

/// A robot as the resolver sees it.
fn mover<'s>(
    robot: &Robot,
    rule: PriorityRule,
    (mission, navigator): (&'s Mission, &'s Navigator),
) -> Mover<'s> {
    let speed = mission.speed_of(robot) as f32;
    let wish = if robot.is_able() { navigator.preferred_velocity(robot, speed) } else { Vector::ZERO };
    let route = navigator.traveller(robot.id).route();
    let agent = &mission.agents[robot.id.index()];
    let is_busy = matches!(agent.activity, Activity::Loading(..) | Activity::Resting(_));
    Mover {
        robot: robot.id,
        aerial: robot.is_aerial(),
        position: robot.position,
        velocity: robot.velocity,
        wish,
        retreat_left: None,
        leg_left: route.map_or(0.0, |route| (route.ahead()[0] - robot.position).length()),
        route: route.map_or(&[], |route| route.ahead()),
        trail: navigator.trail(robot.id),
        radius: robot.radius(),
        speed,
        braking: PLANNED_BRAKING * robot.spec.acceleration_mps2 as f32,
        priority: PriorityKey::new(rule, robot.id, agent.task, [robot.energy, robot.hp]),
        known: (!robot.is_aerial()).then(|| mission.knowledge_of(robot.id).obstacles()),
        can_make_room: robot.is_able() && !is_busy,
    }
}
