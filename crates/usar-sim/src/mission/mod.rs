//! The mission: rounds of grouping, searching, rescuing and returning. Robots decide here; what they cause in the world is in `rescue`.

mod agent;
mod area;
mod rescue;
mod round;

use parry2d::math::Vector;
use rne_core::{Difficulty, Grouping, GroupingPolicy, Member, TaskPositions, Team};

pub use agent::{Activity, Agent};
pub use area::TaskArea;
pub use round::{FieldState, Fitness, return_cause, turn_back_cause, unfit_cause};

use crate::event::{Event, EventLog, TurnBackCause};
use crate::ids::{RescueeId, RobotId};
use crate::planning::{Goal, Knowledge, Navigator};
use crate::scenario::{Costs, MissionRules, Scenario};
use crate::seed::{Purpose, stream};
use crate::sensing::{RescueeBlock, SENSING_PERIOD_STEPS, look_around};
use crate::world::{RescueeState, Robot, World};

/// How near a robot comes to its place at home or at a rest place, in metres.
const SLOT_M: f32 = 0.15;

/// How near a robot passes the places of its sweep, in metres.
const SWEEP_M: f32 = 0.8;

/// The group of one task in the current round.
#[derive(Debug, Clone, Default)]
pub struct Group {
    /// Its members, by id.
    pub members: Vec<RobotId>,
    /// Whether it has work to do: it left home and was not called back.
    pub at_work: bool,
}

/// The state of the mission of one trial.
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
    /// Whether no robot that can carry is left.
    pub is_over: bool,
}

const HOME: usize = 2;

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
        Self {
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
            is_over: false,
        }
    }

    /// What a robot knows: what its group knows, or what the team at home knows.
    #[must_use]
    pub fn knowledge_of(&self, robot: RobotId) -> &Knowledge {
        &self.knowledge[self.side_of(robot)]
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
        for robot in world.robots.iter().filter(|robot| robot.is_able()) {
            let side = self.side_of(robot.id);
            look_around(world, &self.blocks, robot, &mut self.knowledge[side], log);
        }
    }

    /// Top speed of a robot: lower with its health, and lower where its group has no live observer.
    #[must_use]
    pub fn speed_of(&self, robot: &Robot, world: &World) -> f64 {
        let blind = self.agents[robot.id.index()].task.is_some_and(|task| {
            let members = &self.groups[task_index(task)].members;
            !members.iter().map(|id| &world.robots[id.index()]).any(|m| m.is_aerial() && m.is_able())
        });
        robot.speed() * if blind { 1.0 - self.rules.blind_speed_loss } else { 1.0 }
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
        if !Self::has_carrier_left(world) {
            self.is_over = true;
            log.push(Event::MissionOver);
            return Ok(());
        }
        if self.everybody_is_home(world) {
            self.end_round(world, log);
            self.begin_round(world, policy, log)?;
        }
        self.turn_back(world, log);
        for task in Difficulty::ALL {
            self.call_back(task, world, log);
        }
        for robot in 0..world.robots.len() {
            self.choose_activity(RobotId(robot as u32), world, navigator, step);
            let goal = self.goal_of(&world.robots[robot], world);
            navigator.set_goal(RobotId(robot as u32), goal);
        }
        Ok(())
    }

    fn everybody_is_home(&self, world: &World) -> bool {
        let home = |robot: &Robot| self.agents[robot.id.index()].activity == Activity::Home;
        world.robots.iter().filter(|robot| robot.is_able()).all(home)
    }

    fn has_carrier_left(world: &World) -> bool {
        world.robots.iter().any(|robot| robot.is_able() && robot.can_carry())
    }

    /// Pools what the groups know, and notes what the round cost each robot.
    fn end_round(&mut self, world: &World, log: &mut EventLog) {
        if self.round == 0 {
            return;
        }
        log.push(Event::RoundEnded { round: self.round });
        let [hard, easy, home] = &mut self.knowledge;
        home.learn_all(world, hard);
        home.learn_all(world, easy);
        for (agent, robot) in self.agents.iter_mut().zip(&world.robots) {
            agent.task = None;
            if let Some([energy, hp]) = agent.levels_at_start {
                let [most_energy, most_hp] = agent.costliest_round;
                agent.costliest_round = [most_energy.max(energy - robot.energy), most_hp.max(hp - robot.hp)];
            }
        }
    }

    /// Groups the robots that are fit, sends the groups out and the others to rest.
    fn begin_round(
        &mut self,
        world: &mut World,
        policy: &dyn GroupingPolicy,
        log: &mut EventLog,
    ) -> Result<(), String> {
        self.round += 1;
        self.unreachable.fill(false);
        for robot in world.robots.iter_mut().filter(|robot| robot.is_able()) {
            if robot.resources < robot.spec.resources {
                robot.resources = robot.spec.resources;
                log.push(Event::Restocked { robot: robot.id, resources: robot.resources });
            }
            self.agents[robot.id.index()].levels_at_start = Some([robot.energy, robot.hp]);
        }
        let able: Vec<RobotId> =
            world.robots.iter().filter(|robot| robot.is_able()).map(|robot| robot.id).collect();
        let (mut fit, mut unfit) = (Vec::new(), Vec::new());
        for id in able {
            match self.unfit_cause(&world.robots[id.index()]) {
                None => fit.push(id),
                Some(cause) => unfit.push((id, cause)),
            }
        }
        let grouping = self.group(world, policy, &fit)?;
        let ids = |group: &[u32]| group.iter().map(|id| RobotId(*id)).collect::<Vec<_>>();
        let (hard, easy) = (ids(&grouping.hard), ids(&grouping.easy));
        log.push(Event::RoundStarted { round: self.round, hard: hard.clone(), easy: easy.clone() });
        self.send_out(Difficulty::Hard, hard, world);
        self.send_out(Difficulty::Easy, easy, world);
        for (id, cause) in unfit {
            let robot = &world.robots[id.index()];
            let way = |task| (robot.rest_slot(task) - robot.position).length();
            let hard_is_nearer = way(Difficulty::Hard) < way(Difficulty::Easy);

            let agent = self.agent(id);
            agent.rest_at = if hard_is_nearer { Difficulty::Hard } else { Difficulty::Easy };
            agent.activity = Activity::ToRest;
            agent.levels_at_start = None;
            log.push(Event::TurnedBack { robot: id, cause });
        }
        Ok(())
    }

    fn unfit_cause(&self, robot: &Robot) -> Option<TurnBackCause> {
        let Agent { costliest_round, has_rested, .. } = self.agents[robot.id.index()];
        let fitness = Fitness { energy: robot.energy, hp: robot.hp, costliest_round, has_rested };
        unfit_cause(&self.rules, &fitness)
    }

    fn group(&self, world: &World, policy: &dyn GroupingPolicy, fit: &[RobotId]) -> Result<Grouping, String> {
        let members = fit.iter().map(|id| {
            let robot = &world.robots[id.index()];
            Ok(Member {
                id: id.0,
                role: robot.role,
                position: [f64::from(robot.home.x), f64::from(robot.home.y)],
                needs: robot.needs().map_err(|error| format!("robot {id}: {error}"))?,
                energy_level: Some(robot.energy),
                hp_level: Some(robot.hp),
            })
        });
        let members = members.collect::<Result<Vec<_>, String>>()?;
        let mut draws = stream(self.trial_seed, Purpose::Grouping, u64::from(self.round));
        let grouping = Team::new(members, Some(self.tasks))
            .and_then(|team| policy.group(&team, &mut draws))
            .map_err(|error| format!("policy {}: {error}", policy.name()))?;
        let mut grouped: Vec<u32> = grouping.easy.iter().chain(&grouping.hard).copied().collect();
        grouped.sort_unstable();
        if grouped.iter().copied().ne(fit.iter().map(|id| id.0)) {
            return Err(format!(
                "policy {} must put each robot into exactly one group; it was given {fit:?} and formed {grouped:?}",
                policy.name()
            ));
        }
        Ok(grouping)
    }

    /// Sends a group to its task, unless nobody in it can carry: then it stays home.
    fn send_out(&mut self, task: Difficulty, members: Vec<RobotId>, world: &World) {
        let at_work = members.iter().any(|id| world.robots[id.index()].can_carry());
        self.knowledge[task_index(task)] = self.knowledge[HOME].clone();
        let area = self.areas[task_index(task)];
        let (mut ground, mut aerial) = (0, 0);
        let flying = members.iter().filter(|id| world.robots[id.index()].is_aerial()).count();
        for id in &members {
            let robot = &world.robots[id.index()];
            let (rank, ranks) =
                if robot.is_aerial() { (&mut aerial, flying) } else { (&mut ground, members.len() - flying) };
            let agent = &mut self.agents[id.index()];
            agent.task = Some(task);
            agent.has_rested = false;
            agent.rest_at = task;
            agent.sweep = area.sweep(robot.observing_range() as f32, *rank, ranks);
            agent.sweep.reverse();
            agent.muster = if robot.is_aerial() { area.hover(*rank, ranks) } else { area.muster(*rank) };
            agent.activity = if at_work { Activity::Searching } else { Activity::Home };
            *rank += 1;
        }
        self.groups[task_index(task)] = Group { members, at_work };
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
            let way_cost = self.way_cost(way, self.speed_of(robot, world));
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
        for id in self.members_in_field(task, world) {
            self.release_claim(id, world);
            self.agent(id).activity = Activity::Returning;
        }
    }

    fn members_in_field(&self, task: Difficulty, world: &World) -> Vec<RobotId> {
        let in_field = |id: &RobotId| {
            world.robots[id.index()].is_able() && self.agents[id.index()].activity.is_in_field()
        };
        self.groups[task_index(task)].members.iter().copied().filter(in_field).collect()
    }

    fn field_state(&self, task: Difficulty, world: &World) -> FieldState {
        let mut field = FieldState::default();
        for id in self.members_in_field(task, world) {
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

    /// Rescuees that a group knows of and that nobody has claimed.
    fn available<'w>(&'w self, task: Difficulty, world: &'w World) -> impl Iterator<Item = RescueeId> + 'w {
        let known = &self.knowledge[task_index(task)].rescuees;
        let block = self.blocks.iter().find(|block| block.task() == task);
        block
            .map(RescueeBlock::ids)
            .unwrap_or_default()
            .filter(move |i| {
                let rescuee = &world.rescuees[*i];
                known[*i]
                    && rescuee.state == RescueeState::Waiting
                    && rescuee.claimed_by.is_none()
                    && !self.unreachable[*i]
            })
            .map(|i| RescueeId(i as u32))
    }

    /// A robot's next activity, where it is free to choose.
    fn choose_activity(&mut self, id: RobotId, world: &mut World, navigator: &Navigator, step: u64) {
        let robot = &world.robots[id.index()];
        let activity = self.agents[id.index()].activity;
        let Some(task) = self.agents[id.index()].task.filter(|_| robot.is_able()) else { return };
        match activity {
            Activity::Approaching(rescuee) if self.is_out_of_reach(id, rescuee, world, navigator) => {
                self.unreachable[rescuee.index()] = true;
                self.release_claim(id, world);
                self.agent(id).activity = Activity::Searching;
            }
            Activity::Searching | Activity::Standby if self.groups[task_index(task)].at_work => {
                let looks_for_work =
                    (step + id.0 as u64).is_multiple_of(SENSING_PERIOD_STEPS) && robot.free_capacity() > 0;
                if looks_for_work && let Some(rescuee) = self.nearest_available(task, id, world) {
                    world.rescuees[rescuee.index()].claimed_by = Some(id);
                    self.agent(id).activity = Activity::Approaching(rescuee);
                    return;
                }
                self.go_on_searching(id, &world.robots[id.index()], navigator);
            }
            _ => {}
        }
    }

    /// Whether a robot's route ends, or there is none, before the rescuee is within reach.
    fn is_out_of_reach(&self, id: RobotId, rescuee: RescueeId, world: &World, navigator: &Navigator) -> bool {
        let traveller = navigator.traveller(id);
        let robot = &world.robots[id.index()];
        let apart = (world.rescuees[rescuee.index()].position - robot.position).length();
        let at_end = traveller.has_arrived(robot.position) && apart > self.rules.reach_m as f32;
        at_end || traveller.leads_nowhere()
    }

    fn go_on_searching(&mut self, id: RobotId, robot: &Robot, navigator: &Navigator) {
        let agent = &mut self.agents[id.index()];
        let traveller = navigator.traveller(id);
        if robot.can_carry() && robot.free_capacity() == 0 {
            agent.sweep.clear();
        } else if agent.activity == Activity::Searching
            && (traveller.has_arrived(robot.position) || traveller.leads_nowhere())
            && traveller.goal().map(|goal| goal.point) == agent.sweep.last().copied()
        {
            agent.sweep.pop();
        }
        agent.activity = if agent.sweep.is_empty() { Activity::Standby } else { Activity::Searching };
    }

    /// The nearest rescuee that a robot may claim: there must be a resource for it in the field that no other claim needs.
    fn nearest_available(&self, task: Difficulty, id: RobotId, world: &World) -> Option<RescueeId> {
        let field = self.members_in_field(task, world);
        let resources: u32 = field.iter().map(|id| world.robots[id.index()].resources).sum();
        let claims = field.iter().filter(|id| self.agents[id.index()].activity.claim().is_some()).count();
        if resources <= claims as u32 {
            return None;
        }
        let here = world.robots[id.index()].position;
        let distance = |id: &RescueeId| (world.rescuees[id.index()].position - here).length_squared();
        self.available(task, world).min_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b)))
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
            Activity::Home | Activity::Loading(..) | Activity::Resting(_) => None,
            Activity::Searching => agent.sweep.last().map(|place| Goal { point: *place, within: SWEEP_M }),
            Activity::Standby => Some(Goal { point: agent.muster, within: SWEEP_M }),
            Activity::Approaching(rescuee) => Some(Goal {
                point: world.rescuees[rescuee.index()].position,
                within: 0.95 * self.rules.reach_m as f32,
            }),
            Activity::Returning => Some(Goal { point: robot.home, within: SLOT_M }),
            Activity::ToRest => Some(Goal { point: robot.rest_slot(agent.rest_at), within: SLOT_M }),
        }
    }
}
