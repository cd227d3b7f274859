//! One trial: a scenario, a policy and a seed in; a record out.

use parry2d::math::Vector;
use rne_core::GroupingPolicy;
use xxhash_rust::xxh3::Xxh3;

use crate::conflict::{Delay, DelayCause, Directive, Mover, PriorityKey, Resolver};
use crate::event::{Event, EventLog};

use crate::ids::RobotId;
use crate::invariant::{Invariants, Overlaps};
use crate::layout::Layout;
use crate::metrics::Metrics;
use crate::mission::{Activity, Ending, Mission};
use crate::planning::{Navigator, PLANNED_BRAKING, Traveller};
use crate::record::{RobotRecord, Status, TrialRecord};
use crate::scenario::{LayoutError, PriorityRule, Scenario};
use crate::vitals::{energy_cost, hp_cost};
use crate::world::{Condition, RescueeState, Robot, STANDING_MPS, World};

/// The state is hashed once in this many steps, and at the end.
const HASH_PERIOD_STEPS: u64 = 50;

/// A running trial.
pub struct Simulation<'a> {
    scenario: &'a Scenario,
    policy: &'a dyn GroupingPolicy,
    seed: u64,
    step: u64,
    world: World,
    mission: Mission,
    navigator: Navigator,
    resolver: Resolver,
    metrics: Metrics,
    log: EventLog,
    tallies: Vec<Tally>,
    hash: Xxh3,
    invariants: Option<Invariants>,
}

/// What is added up for each robot.
#[derive(Debug, Clone, Copy, Default)]
struct Tally {
    initial: [f64; 2],
    spent: [f64; 2],
    distance_m: f64,
    waiting_steps: u64,
    delay: Delay,
    stall: Stall,
    longest_stall: (u64, Delay),
}

/// What held a robot up since it last came nearer.
#[derive(Debug, Clone, Copy, Default)]
struct Stall {
    /// Steps for each cause, and whom it waited for last.
    causes: [(u64, Option<RobotId>); DelayCause::ALL.len()],
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
        let tallies =
            layout.robots.iter().map(|start| Tally { initial: [start.energy, start.hp], ..Tally::default() });
        Ok(Self {
            scenario,
            policy,
            seed,
            step: 0,
            mission: Mission::new(scenario, &world, seed),
            navigator: Navigator::new(scenario, world.robots.len()),
            resolver: Resolver::new(scenario),
            metrics: Metrics::new(world.robots.len()),
            log: EventLog::default(),
            tallies: tallies.collect(),
            hash: Xxh3::new(),
            invariants: None,
            world,
        })
    }

    /// The same trial, with every invariant checked at every step: a violation ends it as failed.
    #[must_use]
    pub fn checked(mut self) -> Self {
        self.invariants = Some(Invariants::new(self.scenario, &self.world));
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
            listen(self.time_s(), self.log.events(), &self.world);
        };
        self.into_record(status)
    }

    /// How the trial ended, once it is over.
    #[must_use]
    pub fn ending(&self) -> Option<Status> {
        if let Some(ending) = self.mission.ending {
            Some(match ending {
                Ending::NoCarrierLeft => Status::NoCarrierLeft,
                Ending::ErrandsOver => Status::ErrandsOver,
            })
        } else if self.step >= self.scenario.steps() {
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

    /// Simulated time, in seconds.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.step as f64 * self.scenario.dt_s
    }

    /// The world as it is now.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The world, to be changed: for tests that seed faults. The next step goes on from what is there.
    pub fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// The mission as it is now.
    #[must_use]
    pub fn mission(&self) -> &Mission {
        &self.mission
    }

    /// The journeys of the robots as they are now.
    #[must_use]
    pub fn navigator(&self) -> &Navigator {
        &self.navigator
    }

    /// Why each robot does not move on, as far as it does not; by id.
    pub fn delays(&self) -> impl Iterator<Item = Delay> + '_ {
        self.tallies.iter().map(|tally| tally.delay)
    }

    /// The events of the last step.
    #[must_use]
    pub fn events(&self) -> &[Event] {
        self.log.events()
    }

    /// One step: all robots decide from the same snapshot, then all act.
    ///
    /// # Errors
    /// The policy fails, or the physics breaks down.
    pub fn step(&mut self) -> Result<(), String> {
        self.log.clear();
        self.mission.sense(&self.world, self.step, &mut self.log);
        self.mission.decide(&mut self.world, &mut self.navigator, self.policy, self.step, &mut self.log)?;
        self.metrics.listen(self.log.events(), &self.world, self.time_s());
        let heard = self.log.events().len();
        self.plan();
        self.resolve_and_drive();
        self.world.integrate();
        self.step += 1;
        self.expose();
        self.mission.settle(&mut self.world, &self.navigator, self.step, &mut self.log);
        self.metrics.listen(&self.log.events()[heard..], &self.world, self.time_s());
        if self.step.is_multiple_of(HASH_PERIOD_STEPS) {
            self.hash_state();
        }
        let time_s = self.time_s();
        if let Some(invariants) = &mut self.invariants {
            invariants.listen(time_s, self.log.events(), &self.world).map_err(|broken| broken.to_string())?;
        }
        if self.world.physics.is_broken() {
            return Err(format!(
                "the physics broke down at {:.2} s: a body's state is not finite",
                self.time_s()
            ));
        }
        Ok(())
    }

    fn plan(&mut self) {
        let (mission, world) = (&self.mission, &self.world);
        let speed_of = |robot: &Robot| mission.speed_of(robot, world);
        self.navigator.plan(world, |robot| mission.knowledge_of(robot), speed_of, self.step);
    }

    /// Resolves conflicts, and lets each drive come as near to what it is told as its force allows.
    fn resolve_and_drive(&mut self) {
        let (world, mission, navigator) = (&self.world, &self.mission, &self.navigator);
        let rule = self.scenario.conflicts.priority;
        let mut movers: Vec<Mover> =
            world.robots.iter().map(|robot| mover(robot, rule, (world, mission, navigator))).collect();
        let directives = self.resolver.resolve(&mut movers, &mut self.log);
        for ((robot, directive), tally) in self.world.robots.iter().zip(directives).zip(&mut self.tallies) {
            let greatest_change = (robot.spec.acceleration_mps2 * self.scenario.dt_s) as f32;
            let change = (directive.velocity() - robot.velocity).clamp_length_max(greatest_change);
            self.world.physics.drive(robot.id, change);

            let traveller = self.navigator.traveller(robot.id);
            let activity = self.mission.agents[robot.id.index()].activity;
            tally.note_delay(Delay {
                cause: delay_cause(robot, activity, traveller, *directive),
                waits_for: directive.waits_for(),
            });
            tally.note_stall(traveller.stalled_steps());
        }
    }

    /// Energy for moving, HP for radiation; robots that have none left stay where they are.
    fn expose(&mut self) {
        let (costs, dt) = (self.scenario.costs, self.scenario.dt_s);
        for (robot, tally) in self.world.robots.iter_mut().zip(&mut self.tallies) {
            let speed = robot.velocity.length();
            let metres = f64::from(speed) * dt;
            tally.distance_m += metres;
            let resting = matches!(self.mission.agents[robot.id.index()].activity, Activity::Resting(_));
            if !robot.is_able() || resting {
                continue;
            }
            let zones = self.world.zones.iter().filter(|zone| zone.contains(robot.position)).count();
            let energy = energy_cost(&costs.energy, speed > STANDING_MPS, metres, dt).min(robot.energy);
            let hp = hp_cost(&costs.hp, zones, metres, dt).min(robot.hp);
            robot.energy -= energy;
            robot.hp -= hp;
            tally.spent = [tally.spent[0] + energy, tally.spent[1] + hp];
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

    fn hash_state(&mut self) {
        for robot in &self.world.robots {
            let places = [robot.position, robot.velocity].into_iter().flat_map(|v| [v.x, v.y]);
            places.for_each(|value| self.hash.update(&value.to_le_bytes()));
            [robot.energy, robot.hp].iter().for_each(|level| self.hash.update(&level.to_le_bytes()));
            self.hash.update(&(robot.load.len() as u32).to_le_bytes());
            self.hash.update(&robot.resources.to_le_bytes());
            self.hash.update(&[robot.condition as u8]);
        }
        for piece in &self.world.debris {
            let pose = &piece.outline.pose;
            let values = [pose.translation.x, pose.translation.y, pose.rotation.cos(), pose.rotation.sin()];
            values.iter().for_each(|value| self.hash.update(&value.to_le_bytes()));
        }
        for rescuee in &self.world.rescuees {
            let state = match rescuee.state {
                RescueeState::Waiting => u32::MAX,
                RescueeState::Rescued => u32::MAX - 1,
                RescueeState::OnBoard(robot) => robot.0,
            };
            self.hash.update(&state.to_le_bytes());
        }
    }

    fn into_record(mut self, status: Status) -> TrialRecord {
        self.hash_state();
        let seconds = |steps: u64| steps as f64 * self.scenario.dt_s;
        let robots = self.world.robots.iter().zip(&self.tallies).map(|(robot, tally)| RobotRecord {
            robot: robot.id.0,
            role: robot.role,
            initial_energy: tally.initial[0],
            initial_hp: tally.initial[1],
            final_energy: robot.energy,
            final_hp: robot.hp,
            energy_spent: tally.spent[0],
            hp_lost: tally.spent[1],
            distance_m: tally.distance_m,
            waiting_s: seconds(tally.waiting_steps),
            longest_stall_s: seconds(tally.longest_stall.0),
            stall: tally.longest_stall.1,
            stranded: robot.condition == Condition::Stranded,
            disabled: robot.condition == Condition::Disabled,
        });
        TrialRecord {
            policy: self.policy.name().to_owned(),
            seed: self.seed,
            status,
            time_s: self.time_s(),
            hard: self.metrics.tasks[0],
            easy: self.metrics.tasks[1],
            ungrouped_energy: self.metrics.ungrouped[0],
            ungrouped_hp: self.metrics.ungrouped[1],
            completed_rounds: self.metrics.completed_rounds,
            robots: robots.collect(),
            turned_back: self.metrics.turned_back,
            conflicts: self.metrics.conflicts,
            deadlocks: self.metrics.deadlocks,
            rotations: self.metrics.rotations,
            retreats: self.metrics.retreats,
            back_offs: self.metrics.back_offs,
            errands_done: self.metrics.errands_done,
            unreachable: self.metrics.unreachable,
            state_hash: format!("{:032x}", self.hash.digest128()),
            rounds: self.metrics.rounds,
        }
    }
}

impl Tally {
    fn note_delay(&mut self, delay: Delay) {
        self.waiting_steps += u64::from(delay.cause.is_waiting());
        self.delay = delay;
    }

    /// `steps` since the robot last came nearer. What took the most of them is the cause.
    fn note_stall(&mut self, steps: u64) {
        if steps == 0 {
            self.stall = Stall::default();
            return;
        }
        let (count, waits_for) = &mut self.stall.causes[self.delay.cause as usize];
        *count += 1;
        *waits_for = self.delay.waits_for.or(*waits_for);
        if steps > self.longest_stall.0 {
            let causes = DelayCause::ALL.into_iter().zip(self.stall.causes);
            let most = causes.rev().max_by_key(|(_, (count, _))| *count);
            let delay = most.map(|(cause, (_, waits_for))| Delay { cause, waits_for });
            self.longest_stall = (steps, delay.unwrap_or_default());
        }
    }
}

/// A robot as the resolver sees it.
fn mover<'s>(
    robot: &Robot,
    rule: PriorityRule,
    (world, mission, navigator): (&World, &'s Mission, &'s Navigator),
) -> Mover<'s> {
    let speed = mission.speed_of(robot, world) as f32;
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
        way_left: route.map_or(0.0, |route| route.length(robot.position)),
        leg_left: route.map_or(0.0, |route| (route.ahead()[0] - robot.position).length()),
        route: route.map_or(&[], |route| route.ahead()),
        trail: navigator.trail(robot.id),
        radius: robot.radius(),
        speed,
        braking: PLANNED_BRAKING * robot.spec.acceleration_mps2 as f32,
        priority: PriorityKey::new(rule, robot.id, agent.task, [robot.energy, robot.hp]),
        obstacles: if robot.is_aerial() { &[] } else { mission.knowledge_of(robot.id).obstacles() },
        can_make_room: robot.is_able() && !is_busy,
    }
}

/// Why a robot does not move on, as far as it does not.
fn delay_cause(robot: &Robot, activity: Activity, traveller: &Traveller, directive: Directive) -> DelayCause {
    match robot.condition {
        Condition::Stranded => return DelayCause::Stranded,
        Condition::Disabled => return DelayCause::Disabled,
        Condition::Able => {}
    }
    match directive {
        Directive::Yield { .. } => DelayCause::RightOfWay,
        Directive::Blocked { .. } => DelayCause::Blocked,
        Directive::Retreat { .. } => DelayCause::MakingRoom,
        Directive::BackOff(_) => DelayCause::BackingOff,
        Directive::Proceed(_) => DelayCause::UnderWay,
        Directive::Stand => match activity {
            Activity::Loading(..) => DelayCause::Loading,
            Activity::Resting(_) => DelayCause::Resting,
            _ if traveller.leads_nowhere() => DelayCause::NoRoute,
            _ => DelayCause::NothingToDo,
        },
    }
}
