//! The crew: what each robot does, and the groups in which robots work.

use scenario::{RestAtHome, RoundEnd};
use serde::{Deserialize, Serialize};
use teaming::TaskId;

use super::agent::{Activity, Agent};
use super::round::{Fitness, unfit_cause};
use super::scene::Scene;
use super::{SLOT_M, SWEEP_M};
use crate::belief::KnownRobot;
use crate::belief::{Beliefs, Holder};
use crate::event::{Event, TurnBackCause};
use crate::ids::RobotId;
use crate::model::{MissionModel, Model};
use crate::navigation::Goal;
use crate::robot::RobotState;
use crate::telemetry::Presence;

/// The group of one task in the current round.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Group {
    /// Its members, by id.
    pub members: Vec<RobotId>,
    /// Whether the group works: it left home and was not called back.
    pub at_work: bool,
}

/// The place of a robot among its mates that move as it does.
struct Place {
    rank: usize,
    ranks: usize,
}

impl Place {
    fn of(robot: &KnownRobot, mates: &[RobotId], team: &[KnownRobot]) -> Self {
        let alike = || mates.iter().filter(|mate| team[mate.index()].is_aerial() == robot.is_aerial());
        Self { rank: alike().take_while(|mate| **mate != robot.id).count(), ranks: alike().count() }
    }
}

/// What each robot does, and the groups.
#[derive(Serialize, Deserialize)]
pub struct Crew {
    /// What each robot is doing, by id.
    pub agents: Vec<Agent>,
    /// The group of each task.
    pub groups: Vec<Group>,
    /// For each task, whether its group has a guide that can act. Found anew in every step.
    #[serde(skip)]
    is_guided: Vec<bool>,
}

impl Crew {
    /// A crew of which all robots are at home, or on their errands.
    pub(super) fn new(model: &Model) -> Self {
        let mut crew = Self {
            agents: vec![Agent::new(); model.robots.len()],
            groups: vec![Group::default(); model.tasks.len()],
            is_guided: vec![false; model.tasks.len()],
        };
        crew.hand_out_errands(model);
        crew
    }

    /// The task of a robot's group in this round; none for a robot without a group.
    pub(crate) fn group_of(&self, robot: RobotId) -> Option<TaskId> {
        self.agents[robot.index()].task
    }

    /// The members of a robot's group, itself among them.
    pub fn mates_of(&self, robot: RobotId) -> &[RobotId] {
        self.group_of(robot).map_or(&[], |task| &self.groups[task.index()].members)
    }

    /// The belief on which a robot acts; none for the belief of the team at home.
    pub fn holder_of(&self, robot: RobotId, model: &Model) -> Option<Holder> {
        Some(Holder::of(model.mission.belief_sharing, robot, self.group_of(robot)?))
    }

    pub(super) fn agent(&mut self, robot: RobotId) -> &mut Agent {
        &mut self.agents[robot.index()]
    }

    /// Top speed of a robot, in metres per second. It falls with its health and with its load, and in a group
    /// without a guide that can act.
    pub fn speed_of(&self, model: &Model, robot: &RobotState) -> f64 {
        let rules = &model.mission;
        let task = self.agents[robot.id.index()].task;
        let is_blind = task.is_some_and(|task| !self.is_guided[task.index()]);
        let unladen = robot.speed() * if is_blind { rules.blind_speed } else { 1.0 };
        unladen * (1.0 - rules.load_speed_loss * robot.load_share())
    }

    /// Where a robot is in the mission, for telemetry.
    pub(crate) fn presence(&self, model: &Model, robot: &KnownRobot) -> Presence {
        let activity = &self.agents[robot.id.index()].activity;
        Presence {
            is_home: *activity == Activity::Home,
            is_in_field: activity.is_in_field(),
            is_resting: matches!(activity, Activity::Resting(_)),
            known_loss: self.speed_of(model, robot) / robot.speed(),
        }
    }

    /// Notes which groups have a guide that can act.
    pub fn look_for_guides(&mut self, rules: &MissionModel, team: &[KnownRobot]) {
        let guides = |id: &RobotId| {
            let robot = &team[id.index()];
            let is_there = rules.resting_guides || !self.agents[id.index()].activity.is_rest();
            robot.spec.guides && robot.is_able() && is_there
        };
        self.is_guided.clear();
        self.is_guided.extend(self.groups.iter().map(|group| group.members.iter().any(guides)));
    }

    /// The members of a group that can act and work in the field, by id.
    pub(super) fn in_field<'m>(
        &'m self,
        task: TaskId,
        team: &'m [KnownRobot],
    ) -> impl Iterator<Item = RobotId> + 'm {
        let is_in_field =
            |id: &RobotId| team[id.index()].is_able() && self.agents[id.index()].activity.is_in_field();
        self.groups[task.index()].members.iter().copied().filter(is_in_field)
    }

    /// Whether a robot may claim a rescuee in this step.
    pub(super) fn looks_for_work(&self, id: RobotId, scene: &Scene) -> bool {
        let robot = &scene.beliefs.team[id.index()];
        let is_free = matches!(self.agents[id.index()].activity, Activity::Searching | Activity::Standby);
        is_free && robot.is_able() && robot.free_capacity() > 0
    }

    /// Resources of a group in the field that no claim needs; negative if there are more claims than
    /// resources.
    pub(super) fn spare_resources(&self, task: TaskId, team: &[KnownRobot]) -> i64 {
        let resources = |id: RobotId| i64::from(team[id.index()].resources);
        let claims = |id: RobotId| i64::from(self.agents[id.index()].activity.claim().is_some());
        self.in_field(task, team).map(|id| resources(id) - claims(id)).sum()
    }

    /// Resources that the members of a group in the field have.
    pub(super) fn resources_in_field(&self, task: TaskId, team: &[KnownRobot]) -> u32 {
        self.in_field(task, team).map(|id| team[id.index()].resources).sum()
    }

    /// The member in the task area with the most resources left (the lowest id among equals).
    pub(super) fn sharing_member(&self, task: TaskId, scene: &Scene) -> Option<RobotId> {
        let (area, team) = (&scene.model.tasks[task.index()].area, &scene.beliefs.team);
        let shares = |id: &RobotId| {
            let member = &team[id.index()];
            member.resources > 0 && area.contains(member.position)
        };
        let resources = |id: &RobotId| team[id.index()].resources;
        self.in_field(task, team).filter(shares).max_by_key(|id| (resources(id), u32::MAX - id.0))
    }

    /// Whether every robot for which the team waits is at home.
    pub(super) fn everybody_is_home(&self, scene: &Scene) -> bool {
        let agent = |robot: &KnownRobot| &self.agents[robot.id.index()];
        let waits_for_resting = scene.model.mission.round_end == RoundEnd::EverybodyHome;
        let waited_for = |robot: &&KnownRobot| {
            let agent = agent(robot);
            robot.is_able() && !agent.is_cut_off && (waits_for_resting || !agent.is_off_to_rest())
        };
        let mut awaited = scene.beliefs.team.iter().filter(waited_for).peekable();
        awaited.peek().is_some() && awaited.all(|robot| agent(robot).activity == Activity::Home)
    }

    /// Whether a round has a purpose: a robot at home can go out and carry, or can go to rest.
    pub(super) fn can_begin_round(&self, scene: &Scene) -> bool {
        let rules = &scene.model.mission;
        let tasks = scene.model.tasks.len() as u16;
        scene.beliefs.team.iter().any(|robot| {
            let agent = &self.agents[robot.id.index()];
            robot.is_able()
                && agent.activity == Activity::Home
                && match self.unfit_cause(rules, robot) {
                    None => robot.can_carry(),
                    Some(_) => !agent.has_given_up_all_rests(tasks),
                }
        })
    }

    /// Why a robot must rest before it can take part in a round; `None` if it is fit.
    pub(super) fn unfit_cause(&self, rules: &MissionModel, robot: &RobotState) -> Option<TurnBackCause> {
        let Agent { costliest_round, has_rested, .. } = self.agents[robot.id.index()];
        let fitness = Fitness { energy: robot.energy, hp: robot.hp, costliest_round, has_rested };
        unfit_cause(rules, &fitness)
    }

    /// Sends the unfit robots at home to rest, if the rules let the next round wait for their rest. Returns
    /// whether there are any.
    pub(super) fn rest_first(&mut self, scene: &mut Scene) -> bool {
        let rules = &scene.model.mission;
        if rules.rest_at_home == RestAtHome::DuringRound {
            return false;
        }
        let tasks = self.groups.len() as u16;
        let unfit: Vec<(RobotId, TurnBackCause)> = scene
            .beliefs
            .team
            .iter()
            .filter(|robot| robot.is_able())
            .filter(|robot| {
                let agent = &self.agents[robot.id.index()];
                agent.activity == Activity::Home && !agent.has_given_up_all_rests(tasks)
            })
            .filter_map(|robot| Some((robot.id, self.unfit_cause(rules, robot)?)))
            .collect();
        unfit.iter().for_each(|(id, cause)| self.send_to_rest(*id, *cause, scene));
        !unfit.is_empty()
    }

    /// Sends a robot to the nearest rest place that it has not given up on.
    pub(super) fn send_to_rest(&mut self, id: RobotId, cause: TurnBackCause, scene: &mut Scene) {
        let robot = &scene.beliefs.team[id.index()];
        let agent = &mut self.agents[id.index()];
        let way = |task: &TaskId| (robot.rest_slot(*task) - robot.position).length();
        let places = scene.model.task_ids().rev().filter(|task| !agent.has_given_up_rest(*task));
        // Among equally distant rest places, the one of the last task.
        let nearest = places.min_by(|a, b| way(a).total_cmp(&way(b)));
        agent.rest_at = nearest.unwrap_or_default();
        agent.go_to_rest();
        scene.log.push(Event::TurnedBack { robot: id, cause });
    }

    /// Sends a group to its task. A group in which no robot can carry stays at home.
    pub(super) fn send_out(
        &mut self,
        task: TaskId,
        members: Vec<RobotId>,
        model: &Model,
        team: &[KnownRobot],
    ) {
        let at_work = members.iter().any(|id| team[id.index()].can_carry());
        let area = &model.tasks[task.index()].area;
        for id in &members {
            let robot = &team[id.index()];
            let Place { rank, ranks } = Place::of(robot, &members, team);
            let agent = &mut self.agents[id.index()];
            agent.task = Some(task);
            agent.has_rested = false;
            agent.rest_at = task;
            agent.muster = if robot.is_aerial() { area.hover(rank, ranks) } else { area.muster(rank) };
            agent.activity = if at_work { Activity::Searching } else { Activity::Home };
            self.share_sweep(*id, &members, model, team);
        }
        self.groups[task.index()] = Group { members, at_work };
    }

    /// A robot takes its part of the sweep of its task, among those whom it holds for its mates.
    pub(super) fn share_sweep(&mut self, id: RobotId, mates: &[RobotId], model: &Model, team: &[KnownRobot]) {
        let (robot, agent) = (&team[id.index()], &mut self.agents[id.index()]);
        let Some(task) = agent.task else { return };
        let Place { rank, ranks } = Place::of(robot, mates, team);
        agent.sweep = model.tasks[task.index()].area.sweep(robot.observing_range() as f32, rank, ranks);
        agent.sweep.reverse();
    }

    /// The goal of a robot, by its activity; none while it loads or if it can no longer act.
    pub(super) fn goal_of(&self, robot: &KnownRobot, model: &Model, beliefs: &Beliefs) -> Option<Goal> {
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
                point: beliefs.of(self.holder_of(robot.id, model)).rescuees.get(rescuee.index())?.waits_at?,
                within: 0.95 * model.mission.reach,
            }),
            Activity::Home | Activity::Returning => Some(Goal { point: robot.home, within: SLOT_M }),
            Activity::ToRest | Activity::Resting(_) => {
                Some(Goal { point: robot.rest_slot(agent.rest_at), within: SLOT_M })
            }
        }
    }
}
