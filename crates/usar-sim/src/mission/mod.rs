//! The mission: rounds of grouping, searching, rescuing and returning. Robots decide here; what they cause in the world is in `rescue`.

mod agent;
mod area;
mod errands;
mod regroup;
mod rescue;
mod round;
mod work;

use parry2d::math::Vector;
use rne_core::{Difficulty, GroupingPolicy, TaskPositions};
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

pub use agent::{Activity, Agent};
pub use area::TaskArea;
pub use round::{FieldState, Fitness, return_cause, turn_back_cause, unfit_cause};

use crate::event::{Event, EventLog};
use crate::ids::RobotId;
use crate::planning::{Goal, Knowledge, Navigator};
use crate::scenario::{Costs, MissionRules, Scenario};
use crate::sensing::{RescueeBlock, SENSING_PERIOD_STEPS, look_around};
use crate::world::{Robot, World};
use work::Supply;

/// How near a robot comes to its place at home or at a rest place, in metres.
const SLOT_M: f32 = 0.15;

/// How near a robot passes the places of its sweep, in metres.
const SWEEP_M: f32 = 0.8;

/// The group of one task in the current round.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Group {
    /// Its members, by id.
    pub members: Vec<RobotId>,
    /// Whether it has work to do: it left home and was not called back.
    pub at_work: bool,
}

/// The state of the mission of one trial.
#[derive(Serialize, Deserialize)]
pub struct Mission {
    rules: MissionRules,
    costs: Costs,
    dt: f64,
    trial_seed: u64,
    tasks: TaskPositions,
    areas: [TaskArea; 2],
    blocks: Vec<RescueeBlock>,
    /// What each robot is doing, by id.
    pub agents: Vec<Agent>,
    /// The groups of the hard and of the easy task.
    pub groups: [Group; 2],
    /// Knowledge of the group of the hard task, of the easy task, and of the team at home.
    knowledge: [Knowledge; 3],
    unreachable: Vec<bool>,
    /// Number of the round, from 1; 0 before the first.
    pub round: u32,
    /// Why there is nothing left to do, once there is nothing.
    pub ending: Option<Ending>,
    has_errands: bool,
    /// For each task, whether its group has a live observer. Found anew in every step, as is the following.
    #[serde(skip)]
    is_guided: [bool; 2],
    #[serde(skip)]
    supplies: [Supply; 2],
}

/// Why a mission is over before its time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Ending {
    /// No robot that can carry is left.
    NoCarrierLeft,
    /// All errands are done or given up.
    ErrandsOver,
}

const HOME: usize = 2;

/// A robot that has known no way to its goal for this long, in seconds, goes on with something else.
const GIVE_UP_S: f64 = 2.0;

fn other(task: Difficulty) -> Difficulty {
    match task {
        Difficulty::Hard => Difficulty::Easy,
        Difficulty::Easy => Difficulty::Hard,
    }
}

/// Place of a task in lists of both tasks.
#[must_use]
pub fn task_index(task: Difficulty) -> usize {
    usize::from(task == Difficulty::Easy)
}

impl Mission {
    /// Everybody is home, nothing is known.
    #[must_use]
    pub fn new(scenario: &Scenario, world: &World, trial_seed: u64) -> Self {
        let home = world.robots.iter().map(|robot| robot.home).sum::<Vector>() / world.robots.len() as f32;
        let nothing = Knowledge::nothing(
            world,
            scenario.ground_radius_m() as f32,
            scenario.planning.clearance_m as f32,
        );
        let mut mission = Self {
            rules: scenario.mission,
            costs: scenario.costs,
            dt: scenario.dt_s,
            trial_seed,
            tasks: TaskPositions { easy: scenario.tasks.easy.center, hard: scenario.tasks.hard.center },
            areas: Difficulty::ALL.map(|task| TaskArea::new(scenario, task, home, world.robots.len())),
            blocks: RescueeBlock::of(world),
            agents: vec![Agent::new(); world.robots.len()],
            groups: [Group::default(), Group::default()],
            knowledge: [nothing.clone(), nothing.clone(), nothing],
            unreachable: vec![false; world.rescuees.len()],
            round: 0,
            ending: None,
            has_errands: !scenario.errands.is_empty(),
            is_guided: [false; 2],
            supplies: Default::default(),
        };
        mission.hand_out_errands(scenario);
        mission
    }

    /// What a robot knows: what its group knows, or what the team at home knows.
    #[must_use]
    pub fn knowledge_of(&self, robot: RobotId) -> &Knowledge {
        &self.knowledge[self.side_of(robot)]
    }

    /// What the groups and the team at home know: a part of the hash chain.
    pub(crate) fn beliefs(&self) -> &impl Serialize {
        &self.knowledge
    }

    /// All but the beliefs: a part of the hash chain.
    pub(crate) fn course(&self) -> impl Serialize + '_ {
        let Self { rules, costs, dt, trial_seed, tasks, areas, blocks, has_errands, .. } = self;
        let Self { agents, groups, unreachable, round, ending, .. } = self;
        let given = (rules, costs, dt, trial_seed, tasks, areas, blocks, has_errands);
        (given, agents, groups, unreachable, round, ending)
    }

    /// Makes anew what a snapshot leaves out because it follows from the rest.
    pub(crate) fn restore(&mut self, world: &World) {
        self.knowledge.iter_mut().for_each(|knowledge| knowledge.restore(world));
        self.look_for_guides(world);
    }

    fn side_of(&self, robot: RobotId) -> usize {
        self.agents[robot.index()].task.map_or(HOME, task_index)
    }

    fn agent(&mut self, robot: RobotId) -> &mut Agent {
        &mut self.agents[robot.index()]
    }

    /// Lets every robot look around.
    pub fn sense(&mut self, world: &World, step: u64, log: &mut EventLog) {
        if !step.is_multiple_of(SENSING_PERIOD_STEPS) {
            return;
        }
        let wrecks: SmallVec<[usize; 16]> = world
            .robots
            .iter()
            .filter(|robot| robot.wreck_at.is_some())
            .map(|robot| robot.id.index())
            .collect();
        for robot in world.robots.iter().filter(|robot| robot.is_able()) {
            let side = self.side_of(robot.id);
            look_around(world, (&self.blocks, &wrecks), robot, &mut self.knowledge[side], log);
        }
    }

    /// Top speed of a robot: lower with its health, and lower where its group has no live observer.
    #[must_use]
    pub fn speed_of(&self, robot: &Robot) -> f64 {
        let task = self.agents[robot.id.index()].task;
        let is_blind = task.is_some_and(|task| !self.is_guided[task_index(task)]);
        robot.speed() * if is_blind { 1.0 - self.rules.blind_speed_loss } else { 1.0 }
    }

    fn look_for_guides(&mut self, world: &World) {
        let guides = |robot: &Robot| robot.is_aerial() && robot.is_able();
        self.is_guided = [0, 1]
            .map(|task: usize| self.groups[task].members.iter().any(|id| guides(&world.robots[id.index()])));
    }

    /// Decides what every robot does next, and sends it there.
    ///
    /// # Errors
    /// The policy fails, or does not put each robot into exactly one group.
    #[expect(
        clippy::too_many_arguments,
        reason = "the step's parts are lent one by one; a struct of them would only rename this list"
    )]
    pub fn decide(
        &mut self,
        world: &mut World,
        navigator: &mut Navigator,
        policy: &dyn GroupingPolicy,
        step: u64,
        log: &mut EventLog,
    ) -> Result<(), String> {
        self.look_for_guides(world);
        if self.has_errands {
            self.follow_errands(world, navigator, log);
        } else if Self::has_carrier_left(world) {
            self.work(world, navigator, policy, step, log)?;
        } else {
            self.ending = Some(Ending::NoCarrierLeft);
            log.push(Event::MissionOver);
        }
        for robot in &world.robots {
            navigator.set_goal(robot.id, self.goal_of(robot, world));
        }
        Ok(())
    }

    #[expect(clippy::too_many_arguments, reason = "those of `decide`")]
    fn work(
        &mut self,
        world: &mut World,
        navigator: &Navigator,
        policy: &dyn GroupingPolicy,
        step: u64,
        log: &mut EventLog,
    ) -> Result<(), String> {
        self.note_cut_off(world, navigator, log);
        if self.everybody_is_home(world) {
            self.end_round(world, log);
            self.begin_round(world, policy, log)?;
            self.look_for_guides(world);
        }
        self.turn_back(world, log);
        for task in Difficulty::ALL {
            self.call_back(task, world, log);
        }
        self.supplies.iter_mut().for_each(Supply::forget);
        for robot in 0..world.robots.len() {
            self.choose_activity(RobotId(robot as u32), world, (navigator, step), log);
        }
        Ok(())
    }

    /// Robots that know no way to their rest place try the other; those that know no way home are not waited for.
    fn note_cut_off(&mut self, world: &World, navigator: &Navigator, log: &mut EventLog) {
        for robot in world.robots.iter().filter(|robot| robot.is_able()) {
            let gives_up = self.gives_up(robot.id, navigator);
            let agent = &mut self.agents[robot.id.index()];
            let was_cut_off = std::mem::replace(&mut agent.is_cut_off, gives_up);
            if !gives_up || was_cut_off {
                continue;
            }
            let place = match agent.activity {
                Activity::ToRest => {
                    let place = robot.rest_slot(agent.rest_at);
                    agent.rest_at = other(agent.rest_at);
                    place
                }
                Activity::Returning | Activity::Home => robot.home,
                _ => continue,
            };
            log.push(Event::Unreachable { robot: robot.id, place: place.into() });
        }
    }

    fn has_carrier_left(world: &World) -> bool {
        world.robots.iter().any(|robot| robot.is_able() && robot.can_carry())
    }

    /// Sends robots to rest that must leave the field.
    fn turn_back(&mut self, world: &mut World, log: &mut EventLog) {
        for id in 0..self.agents.len() {
            let (robot, agent) = (&world.robots[id], &self.agents[id]);
            let underway = agent.activity.is_in_field()
                || agent.activity == Activity::Returning && agent.levels_at_start.is_some();
            if !robot.is_able() || !underway {
                continue;
            }
            let way = f64::from((robot.rest_slot(agent.rest_at) - robot.position).length());
            let way_cost = self.way_cost(way, self.speed_of(robot));
            if let Some(cause) = turn_back_cause(&self.rules, robot.energy, robot.hp, way_cost) {
                self.release_claim(RobotId(id as u32), world);
                let agent = &mut self.agents[id];
                agent.activity = Activity::ToRest;
                agent.levels_at_start = None;
                log.push(Event::TurnedBack { robot: RobotId(id as u32), cause });
            }
        }
    }

    /// Energy that a way of this length costs, in percent points.
    fn way_cost(&self, metres: f64, speed: f64) -> f64 {
        let rates = &self.costs.energy;
        let seconds = metres / speed.max(1e-3);
        seconds * (rates.per_step / self.dt + rates.per_second) + metres * rates.per_metre
    }

    /// Calls a group home when it can do no more.
    fn call_back(&mut self, task: Difficulty, world: &mut World, log: &mut EventLog) {
        if !self.groups[task_index(task)].at_work {
            return;
        }
        let Some(cause) = return_cause(&self.field_state(task, world)) else { return };
        log.push(Event::GroupReturned { task, cause });
        self.groups[task_index(task)].at_work = false;
        for id in self.in_field(task, world).collect::<Vec<_>>() {
            self.release_claim(id, world);
            self.agent(id).activity = Activity::Returning;
        }
    }

    /// The members of a group that can act and work in the field, by id.
    fn in_field<'m>(&'m self, task: Difficulty, world: &'m World) -> impl Iterator<Item = RobotId> + 'm {
        let is_in_field = |id: &RobotId| {
            world.robots[id.index()].is_able() && self.agents[id.index()].activity.is_in_field()
        };
        self.groups[task_index(task)].members.iter().copied().filter(is_in_field)
    }

    fn field_state(&self, task: Difficulty, world: &World) -> FieldState {
        let mut field = FieldState::default();
        for id in self.in_field(task, world) {
            let (robot, agent) = (&world.robots[id.index()], &self.agents[id.index()]);
            field.carrying_members += u32::from(robot.can_carry());
            field.free_capacity += robot.free_capacity();
            field.resources += robot.resources;
            field.known_rescuees += u32::from(agent.activity.claim().is_some());
            field.still_searching += u32::from(!agent.sweep.is_empty());
        }
        if field.still_searching == 0 && field.known_rescuees == 0 {
            field.known_rescuees = self.available(task, world).count() as u32;
        }
        field
    }

    fn release_claim(&mut self, id: RobotId, world: &mut World) {
        if let Some(rescuee) = self.agents[id.index()].activity.claim() {
            world.rescuees[rescuee.index()].claimed_by = None;
        }
    }

    /// Where a robot wants to be.
    fn goal_of(&self, robot: &Robot, world: &World) -> Option<Goal> {
        let agent = &self.agents[robot.id.index()];
        if !robot.is_able() {
            return None;
        }
        match agent.activity {
            Activity::Loading(..) | Activity::Resting(_) => None,
            Activity::OnErrand => agent.sweep.last().map(|place| Goal { point: *place, within: SLOT_M }),
            Activity::Searching => agent.sweep.last().map(|place| Goal { point: *place, within: SWEEP_M }),
            Activity::Standby => Some(Goal { point: agent.muster, within: SWEEP_M }),
            Activity::Approaching(rescuee) => Some(Goal {
                point: world.rescuees[rescuee.index()].position,
                within: 0.95 * self.rules.reach_m as f32,
            }),
            Activity::Home | Activity::Returning => Some(Goal { point: robot.home, within: SLOT_M }),
            Activity::ToRest => Some(Goal { point: robot.rest_slot(agent.rest_at), within: SLOT_M }),
        }
    }
}
