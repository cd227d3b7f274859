//! Between rounds: who is home, who is fit, the grouping, and the way out.

use rne_core::{Difficulty, Grouping, GroupingPolicy, Member, Team};

use super::round::{Fitness, unfit_cause};
use super::{Activity, Agent, Group, HOME, Mission, task_index};
use crate::event::{Event, EventLog, TurnBackCause};
use crate::ids::RobotId;
use crate::seed::{Purpose, stream};
use crate::world::{Robot, World};

impl Mission {
    pub(super) fn everybody_is_home(&self, world: &World) -> bool {
        let agent = |robot: &Robot| &self.agents[robot.id.index()];
        let waited_for = |robot: &&Robot| robot.is_able() && !agent(robot).is_cut_off;
        let mut awaited = world.robots.iter().filter(waited_for).peekable();
        awaited.peek().is_some() && awaited.all(|robot| agent(robot).activity == Activity::Home)
    }

    /// Pools what the groups know, and notes what the round cost each robot.
    pub(super) fn end_round(&mut self, world: &World, log: &mut EventLog) {
        if self.round == 0 {
            return;
        }
        log.push(Event::RoundEnded { round: self.round });
        let [hard, easy, home] = &mut self.knowledge;
        home.pool(world, [hard, easy]);
        for (agent, robot) in self.agents.iter_mut().zip(&world.robots) {
            agent.task = None;
            if let Some([energy, hp]) = agent.levels_at_start {
                let [most_energy, most_hp] = agent.costliest_round;
                agent.costliest_round = [most_energy.max(energy - robot.energy), most_hp.max(hp - robot.hp)];
            }
        }
    }

    /// Groups the robots that are fit, sends the groups out and the others to rest.
    pub(super) fn begin_round(
        &mut self,
        world: &mut World,
        policy: &dyn GroupingPolicy,
        log: &mut EventLog,
    ) -> Result<(), String> {
        self.round += 1;
        self.unreachable.fill(false);
        let is_home: Vec<bool> = self.agents.iter().map(|a| a.activity == Activity::Home).collect();
        let takes_part = |robot: &Robot| robot.is_able() && is_home[robot.id.index()];
        for robot in world.robots.iter_mut().filter(|robot| takes_part(robot)) {
            if robot.resources < robot.spec.resources {
                robot.resources = robot.spec.resources;
                log.push(Event::Restocked { robot: robot.id, resources: robot.resources });
            }
            self.agents[robot.id.index()].levels_at_start = Some([robot.energy, robot.hp]);
        }
        let able: Vec<RobotId> =
            world.robots.iter().filter(|robot| takes_part(robot)).map(|robot| robot.id).collect();
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
}
