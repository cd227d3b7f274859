//! The mission: rounds of grouping, searching, rescuing and returning. Robots decide here, from what they
//! heard; what they want done becomes an [`Intent`](crate::intent::Intent), and the world has the last word.

mod agent;
mod claims;
mod errands;
mod regroup;
mod round;
mod scene;
mod settle;
mod watch;
mod withdraw;
mod work;

use rne_core::{Question, TaskId};
use serde::{Deserialize, Serialize};

pub use agent::{Activity, Agent};
pub use claims::Claimed;
pub use round::{FieldState, Fitness, return_cause, turn_back_cause, unfit_cause};
pub use scene::Scene;
pub use settle::Sharing;
pub use watch::Watch;

use crate::belief::Beliefs;
use crate::event::{Event, TurnBackCause};
use crate::ids::{RescueeId, RobotId};
use crate::model::{MissionModel, Model};
use crate::navigation::Goal;
use crate::robot::Robot;

/// How near a robot comes to its place at home or at a rest place, in metres.
const SLOT_M: f32 = 0.15;

/// How near a robot passes the places of its sweep, in metres.
const SWEEP_M: f32 = 0.8;

/// A robot that has known no route to its goal for this long, in seconds, gives up on the goal.
const GIVE_UP_S: f64 = 2.0;

/// The group of one task in the current round.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Group {
    /// Its members, by id.
    pub members: Vec<RobotId>,
    /// Whether the group works: it left home and was not called back.
    pub at_work: bool,
}

/// A round that waits for its assignment.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Pending {
    question: Question,
    /// Robots that must rest during the round, and why.
    unfit: Vec<(RobotId, TurnBackCause)>,
}

/// The state of the mission of one trial.
#[derive(Serialize, Deserialize)]
pub struct Mission {
    /// What each robot is doing, by id.
    pub agents: Vec<Agent>,
    /// The group of each task.
    pub groups: Vec<Group>,
    claimed: Claimed,
    /// For each rescuee, whether its group gave up on it in this round.
    unreachable: Vec<bool>,
    /// Number of the round, from 1; 0 before the first.
    pub round: u32,
    /// Why the mission is over, once it is.
    pub ending: Option<Ending>,
    pending: Option<Pending>,
    /// For each task, whether its group has a guide that can act. Found anew in every step.
    is_guided: Vec<bool>,
}

/// Why a mission ends before the duration of the trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Ending {
    /// No robot that can carry is left.
    NobodyCanCarry,
    /// All errands are done or given up.
    ErrandsOver,
}

impl Mission {
    /// A mission in which all robots are at home.
    #[must_use]
    pub fn new(model: &Model) -> Self {
        let tasks = model.tasks.len();
        let mut mission = Self {
            agents: vec![Agent::new(); model.robots.len()],
            groups: vec![Group::default(); tasks],
            claimed: Claimed::nothing(model.rescuees.len()),
            unreachable: vec![false; model.rescuees.len()],
            round: 0,
            ending: None,
            pending: None,
            is_guided: vec![false; tasks],
        };
        mission.hand_out_errands(model);
        mission
    }

    /// The task of a robot's group in this round; none for a robot without a group.
    #[must_use]
    pub fn group_of(&self, robot: RobotId) -> Option<TaskId> {
        self.agents[robot.index()].task
    }

    /// Which robots are on their way to rescuees, or are loading them. A part of the hash chain.
    #[must_use]
    pub fn claimed(&self) -> &Claimed {
        &self.claimed
    }

    /// Whether a rescuee's group gave up on it in this round, because it knows no way there or came no nearer.
    #[must_use]
    pub fn has_given_up(&self, rescuee: RescueeId) -> bool {
        self.unreachable[rescuee.index()]
    }

    /// The question that waits for an assignment, if there is one.
    #[must_use]
    pub fn question(&self) -> Option<&Question> {
        self.pending.as_ref().map(|pending| &pending.question)
    }

    /// The state of the mission without the claims: a part of the hash chain.
    pub(crate) fn course(&self) -> impl Serialize + '_ {
        let Self { agents, groups, unreachable, round, ending, pending, .. } = self;
        (agents, groups, unreachable, round, ending, pending)
    }

    fn agent(&mut self, robot: RobotId) -> &mut Agent {
        &mut self.agents[robot.index()]
    }

    /// Top speed of a robot, in metres per second. It falls with its health and with its load, and in a group
    /// without a guide that can act.
    #[must_use]
    pub fn speed_of(&self, model: &Model, robot: &Robot) -> f64 {
        let rules = &model.mission;
        let task = self.agents[robot.id.index()].task;
        let is_blind = task.is_some_and(|task| !self.is_guided[task.index()]);
        let unladen = robot.speed() * if is_blind { rules.blind_speed } else { 1.0 };
        unladen * (1.0 - rules.load_speed_loss * robot.load_share())
    }

    fn look_for_guides(&mut self, rules: &MissionModel, team: &[Robot]) {
        let guides = |id: &RobotId| {
            let robot = &team[id.index()];
            let is_there = rules.resting_guides || !self.agents[id.index()].activity.is_rest();
            robot.spec.guides && robot.is_able() && is_there
        };
        for (is_guided, group) in self.is_guided.iter_mut().zip(&self.groups) {
            *is_guided = group.members.iter().any(guides);
        }
    }

    /// Begins the decisions of a step: notes which robots are cut off, and ends and begins rounds. A new
    /// round waits for its assignment: see [`Mission::question`]. Returns the robots that the base restocks.
    pub fn prepare(&mut self, scene: &mut Scene) -> Vec<RobotId> {
        self.look_for_guides(&scene.model.mission, &scene.beliefs.team);
        if !scene.model.errands.is_empty() {
            self.follow_errands(scene);
        } else if scene.beliefs.team.iter().any(|robot| robot.is_able() && robot.can_carry()) {
            self.watch(scene);
            if self.everybody_is_home(scene) && self.can_begin_round(scene) && !self.rest_first(scene) {
                self.end_round(scene);
                return self.open_round(scene);
            }
        } else {
            self.ending = Some(Ending::NobodyCanCarry);
            scene.log.push(Event::MissionOver);
        }
        Vec::new()
    }

    /// Decides what every robot does next, and sets its goal.
    pub fn act(&mut self, scene: &mut Scene) {
        if self.ending.is_none() && scene.model.errands.is_empty() {
            self.turn_back(scene);
            for task in scene.model.task_ids() {
                self.call_back(task, scene);
            }
            let mut claims = self.claims(scene).into_iter().peekable();
            for robot in (0..scene.beliefs.team.len() as u32).map(RobotId) {
                let claim = claims.next_if(|(by, _)| *by == robot).map(|(_, rescuee)| rescuee);
                self.choose_activity(robot, claim, scene);
            }
        }
        for robot in &scene.beliefs.team {
            let goal = self.goal_of(robot, scene.model, scene.beliefs);
            scene.navigator.set_goal(robot.id, goal);
        }
    }

    /// Sends robots that must leave the field to rest.
    fn turn_back(&mut self, scene: &mut Scene) {
        for id in 0..self.agents.len() {
            let (robot, agent) = (&scene.beliefs.team[id], &self.agents[id]);
            let underway = agent.activity.is_in_field()
                || agent.activity == Activity::Returning && agent.levels_at_start.is_some();
            if !robot.is_able() || !underway {
                continue;
            }
            let way = f64::from((robot.rest_slot(agent.rest_at) - robot.position).length());
            let way_cost = scene.way_cost(robot, way, self.speed_of(scene.model, robot));
            let rules = &scene.model.mission;
            if let Some(cause) = turn_back_cause(rules, robot.energy, robot.hp, way_cost) {
                self.release_claim(RobotId(id as u32));
                self.agents[id].go_to_rest();
                scene.log.push(Event::TurnedBack { robot: RobotId(id as u32), cause });
            }
        }
    }

    /// Calls a group home if it can do no more.
    fn call_back(&mut self, task: TaskId, scene: &mut Scene) {
        if !self.groups[task.index()].at_work {
            return;
        }
        let Some(cause) = return_cause(&self.field_state(task, scene)) else { return };
        scene.log.push(Event::GroupReturned { task, cause });
        self.groups[task.index()].at_work = false;
        for id in self.in_field(task, &scene.beliefs.team).collect::<Vec<_>>() {
            self.release_claim(id);
            self.agent(id).activity = Activity::Returning;
        }
    }

    /// The members of a group that can act and work in the field, by id.
    fn in_field<'m>(&'m self, task: TaskId, team: &'m [Robot]) -> impl Iterator<Item = RobotId> + 'm {
        let is_in_field =
            |id: &RobotId| team[id.index()].is_able() && self.agents[id.index()].activity.is_in_field();
        self.groups[task.index()].members.iter().copied().filter(is_in_field)
    }

    fn field_state(&self, task: TaskId, scene: &Scene) -> FieldState {
        let mut field = FieldState::default();
        for id in self.in_field(task, &scene.beliefs.team) {
            let (robot, agent) = (&scene.beliefs.team[id.index()], &self.agents[id.index()]);
            field.carrying_members += u32::from(robot.can_carry());
            field.free_capacity += robot.free_capacity();
            field.resources += robot.resources;
            field.known_rescuees += u32::from(agent.activity.claim().is_some());
            field.still_searching += u32::from(!agent.sweep.is_empty());
        }
        if field.still_searching == 0 && field.known_rescuees == 0 {
            field.known_rescuees = self.available(task, scene).count() as u32;
        }
        field
    }

    fn release_claim(&mut self, id: RobotId) {
        if let Some(rescuee) = self.agents[id.index()].activity.claim() {
            self.claimed.set(rescuee, None);
        }
    }

    /// The goal of a robot, by its activity; none while it loads or if it can no longer act.
    fn goal_of(&self, robot: &Robot, model: &Model, beliefs: &Beliefs) -> Option<Goal> {
        let agent = &self.agents[robot.id.index()];
        if !robot.is_able() {
            return None;
        }
        match agent.activity {
            Activity::Loading(..) => None,
            Activity::OnErrand => agent.sweep.last().map(|place| Goal { point: *place, within: SLOT_M }),
            Activity::Searching => agent.sweep.last().map(|place| Goal { point: *place, within: SWEEP_M }),
            Activity::Standby => Some(Goal { point: agent.muster, within: SWEEP_M }),
            Activity::Approaching(rescuee) => Some(Goal {
                point: beliefs.of(agent.task).rescuees.get(rescuee.index())?.waits_at?,
                within: 0.95 * model.mission.reach,
            }),
            Activity::Home | Activity::Returning => Some(Goal { point: robot.home, within: SLOT_M }),
            Activity::ToRest | Activity::Resting(_) => {
                Some(Goal { point: robot.rest_slot(agent.rest_at), within: SLOT_M })
            }
        }
    }
}
