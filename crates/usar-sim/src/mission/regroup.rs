//! Between rounds: which robots are home and fit, the question to the policy, and the departure of the
//! groups.

use rne_core::{Assignment, GroupSizes, Question, Quota, RandomSeed, SCHEMA_VERSION, Task, TaskId};

use super::round::{Fitness, unfit_cause};
use super::{Activity, Agent, Group, Mission, Pending, Scene};
use crate::belief::{Belief, Beliefs};
use crate::event::{Event, TurnBackCause};
use crate::ids::RobotId;
use crate::model::{MissionModel, Model, NeedModel, TaskModel};
use crate::robot::Robot;
use crate::scenario::{EmptyTasks, RestAtHome, RoundEnd};
use crate::seed::{Purpose, stream};

impl Mission {
    /// Whether every robot for which the team waits is at home.
    pub(super) fn everybody_is_home(&self, scene: &Scene) -> bool {
        let agent = |robot: &Robot| &self.agents[robot.id.index()];
        let waits_for_resting = scene.model.mission.round_end == RoundEnd::EverybodyHome;
        let waited_for = |robot: &&Robot| {
            let agent = agent(robot);
            robot.is_able() && !agent.is_cut_off && (waits_for_resting || !agent.is_off_to_rest())
        };
        let mut awaited = scene.beliefs.team.iter().filter(waited_for).peekable();
        awaited.peek().is_some() && awaited.all(|robot| agent(robot).activity == Activity::Home)
    }

    /// Pools the beliefs of the groups, and notes what the round cost each robot.
    pub(super) fn end_round(&mut self, scene: &mut Scene) {
        if self.round == 0 {
            return;
        }
        scene.log.push(Event::RoundEnded { round: self.round });
        scene.beliefs.pool();
        let went_to_rest = |id: RobotId| self.agents[id.index()].levels_at_start.is_none();
        let unit = scene.model.costs.unit;
        let Beliefs { team, ledger, .. } = &mut *scene.beliefs;
        ledger.end(team, unit, scene.step as f64 * scene.model.dt_s(), went_to_rest);
        for (agent, robot) in self.agents.iter_mut().zip(&scene.beliefs.team) {
            agent.task = None;
            if let Some([energy, hp]) = agent.levels_at_start {
                let [most_energy, most_hp] = agent.costliest_round;
                agent.costliest_round = [most_energy.max(energy - robot.energy), most_hp.max(hp - robot.hp)];
            }
        }
    }

    /// Restocks the robots at home, and asks how the fit ones are to be grouped. If no robot is fit, assigns
    /// empty groups without a question. Returns the robots that the base restocks; it knows what it hands out.
    pub(super) fn open_round(&mut self, scene: &mut Scene) -> Vec<RobotId> {
        self.round += 1;
        self.unreachable.fill(false);
        let is_home: Vec<bool> = self.agents.iter().map(|a| a.activity == Activity::Home).collect();
        let takes_part = |robot: &Robot| robot.is_able() && is_home[robot.id.index()];
        let mut restocked = Vec::new();
        for robot in scene.beliefs.team.iter_mut().filter(|robot| takes_part(robot)) {
            if robot.resources < robot.spec.resources {
                robot.resources = robot.spec.resources;
                restocked.push(robot.id);
                scene.log.push(Event::Restocked { robot: robot.id, resources: robot.resources });
            }
            self.agents[robot.id.index()].levels_at_start = Some([robot.energy, robot.hp]);
        }
        let (mut fit, mut unfit) = (Vec::new(), Vec::new());
        let tasks = self.groups.len() as u16;
        for robot in scene.beliefs.team.iter().filter(|robot| takes_part(robot)) {
            let agent = &self.agents[robot.id.index()];
            match self.unfit_cause(&scene.model.mission, robot) {
                None => fit.push(robot),
                Some(_) if agent.has_given_up_all_rests(tasks) => {} // it stays home this time
                Some(cause) => unfit.push((robot.id, cause)),
            }
        }
        let question = question(scene.model, self.round, scene.beliefs.of(None), &fit);
        self.agents.iter_mut().for_each(|agent| agent.rests_given_up = 0);
        let is_empty = question.members.is_empty();
        self.pending = Some(Pending { question, unfit });
        if is_empty {
            self.assign(&Assignment::new(vec![Vec::new(); self.groups.len()]), scene);
        }
        restocked
    }

    pub(super) fn unfit_cause(&self, rules: &MissionModel, robot: &Robot) -> Option<TurnBackCause> {
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
    fn send_to_rest(&mut self, id: RobotId, cause: TurnBackCause, scene: &mut Scene) {
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

    /// Sends the groups out, and the unfit robots to rest. The assignment must answer the question that waits
    /// for one.
    pub fn assign(&mut self, assignment: &Assignment, scene: &mut Scene) {
        let Some(Pending { unfit, .. }) = self.pending.take() else { return };
        let ids = |group: &Vec<u32>| group.iter().map(|id| RobotId(*id)).collect::<Vec<_>>();
        let groups: Vec<Vec<RobotId>> = assignment.groups.iter().map(ids).collect();
        scene.beliefs.ledger.begin(self.round, &groups, scene.step as f64 * scene.model.dt_s());
        scene.log.push(Event::RoundStarted { round: self.round, groups: groups.clone() });
        for (task, members) in scene.model.task_ids().zip(groups) {
            scene.beliefs.depart(task);
            self.send_out(task, members, scene.model, &scene.beliefs.team);
        }
        unfit.iter().for_each(|(id, cause)| self.send_to_rest(*id, *cause, scene));
        self.look_for_guides(&scene.model.mission, &scene.beliefs.team);
    }

    /// Sends a group to its task. A group in which no robot can carry stays at home.
    fn send_out(&mut self, task: TaskId, members: Vec<RobotId>, model: &Model, team: &[Robot]) {
        let at_work = members.iter().any(|id| team[id.index()].can_carry());
        let area = &model.tasks[task.index()].area;
        let (mut ground, mut aerial) = (0, 0);
        let flying = members.iter().filter(|id| team[id.index()].is_aerial()).count();
        for id in &members {
            let robot = &team[id.index()];
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
        self.groups[task.index()] = Group { members, at_work };
    }
}

/// The question how these robots, as they said they are, are to be grouped.
fn question(model: &Model, round: u32, belief: &Belief, fit: &[&Robot]) -> Question {
    let need = |need: &NeedModel| need.asked.clone();
    let tasks = tasks(model, belief);
    let count = |role: usize| fit.iter().filter(|robot| robot.role.index() == role).count();
    let is_open = open_tasks(belief, &tasks, model.mission.empty_tasks);
    let quota = |role: usize| {
        let (asked, sizes) = (asked(model, role, &is_open), model.mission.group_sizes);
        let mut quota = Quota::share(count(role), &asked, &model.hardest_first, sizes);
        if sizes == GroupSizes::Free && model.tasks.iter().all(|task| task.quota[role].is_none()) {
            quota.sizes = sizes; // that a task is closed binds parts; free sizes stay a suggestion
        }
        quota
    };
    Question {
        schema_version: SCHEMA_VERSION,
        round,
        roles: model.roles.clone(),
        needs: model.needs.iter().map(need).collect(),
        quotas: (0..model.roles.len()).map(quota).collect(),
        tasks,
        members: fit.iter().filter_map(|robot| robot.member(&model.needs)).collect(),
        may_idle: model.mission.may_idle,
        history: Vec::new(),
        random_seed: RandomSeed(stream(model.seed, Purpose::Grouping, u64::from(round)).get_seed()),
    }
}

/// The tasks, and how many rescuees wait there by this belief.
fn tasks(model: &Model, belief: &Belief) -> Vec<Task> {
    let task = |(task, id): (&TaskModel, TaskId)| Task {
        rescuees: belief.waiting(id, task.rescuees.clone()),
        ..task.asked.clone()
    };
    model.tasks.iter().zip(model.task_ids()).map(task).collect()
}

/// For each task, whether it gets robots: whether it has begun and not ended and, if the rules ask for it and
/// another task has, whether it has work that the team knows of.
fn open_tasks(belief: &Belief, tasks: &[Task], rule: EmptyTasks) -> Vec<bool> {
    let has_begun = |number: usize| belief.tasks.get(number).is_none_or(|task| task.open);
    let is_empty = |task: &Task| rule == EmptyTasks::GetNobody && task.rescuees == Some(0);
    let has_begun: Vec<bool> = (0..tasks.len()).map(has_begun).collect();
    let has_work: Vec<bool> =
        has_begun.iter().zip(tasks).map(|(begun, task)| *begun && !is_empty(task)).collect();
    if has_work.contains(&true) { has_work } else { has_begun }
}

/// The number of robots of a role for which each task asks.
fn asked(model: &Model, role: usize, is_open: &[bool]) -> Vec<Option<usize>> {
    let mut asked: Vec<Option<usize>> = model.tasks.iter().map(|task| task.quota[role]).collect();
    // A task that is not open asks for no robot; an open one takes the robots that are left.
    if is_open.contains(&false) {
        let takes_the_rest = (0..asked.len()).any(|number| is_open[number] && asked[number].is_none());
        for (asked, is_open) in asked.iter_mut().zip(is_open) {
            *asked = if *is_open { asked.filter(|_| takes_the_rest) } else { Some(0) };
        }
    }
    asked
}
