//! Between rounds: the end of one, the opening of the next, and the departure of the groups.

use scenario::LevelSource;
use teaming::Assignment;

use super::question::question;
use super::{Activity, Mission, Pending, Scene};
use crate::belief::KnownRobot;
use crate::belief::{Beliefs, Holder};
use crate::event::{Event, EventLog};
use crate::ids::RobotId;
use crate::telemetry::{Now, Telemetry};

impl Mission {
    /// Lets telemetry, where there is any, do something at this moment of the trial.
    pub fn with_telemetry(
        &self,
        scene: &mut Scene,
        act: impl FnOnce(&mut Telemetry, &Now<'_>, &mut EventLog),
    ) {
        let Scene { model, beliefs, telemetry: Some(telemetry), log, step, .. } = scene else { return };
        let presence = |robot: &KnownRobot| self.crew.presence(model, robot);
        let now = Now { model, team: &beliefs.team, presence: &presence, step: *step, round: self.round };
        act(telemetry, &now, log);
    }

    /// Pools the beliefs of the groups, and notes what the round cost each robot.
    pub(super) fn end_round(&mut self, scene: &mut Scene) {
        if self.round == 0 {
            return;
        }
        scene.log.push(Event::RoundEnded { round: self.round });
        scene.beliefs.pool();
        let went_to_rest = |id: RobotId| self.crew.agents[id.index()].levels_at_start.is_none();
        let unit = scene.model.costs.unit;
        let Beliefs { team, ledger, .. } = &mut *scene.beliefs;
        ledger.end(team, unit, scene.step as f64 * scene.model.dt_s(), went_to_rest);
        self.with_telemetry(scene, Telemetry::rate);
        for (agent, robot) in self.crew.agents.iter_mut().zip(&scene.beliefs.team) {
            agent.task = None;
            if let Some([energy, hp]) = agent.levels_at_start {
                let [most_energy, most_hp] = agent.costliest_round;
                agent.costliest_round = [most_energy.max(energy - robot.energy), most_hp.max(hp - robot.hp)];
            }
        }
    }

    /// Restocks the robots at home, and asks how the fit ones are to be grouped. If no robot is fit, assigns
    /// empty groups without a question. Returns the robots that the base restocks; it knows what it hands
    /// out.
    pub(super) fn open_round(&mut self, scene: &mut Scene) -> Vec<RobotId> {
        self.round += 1;
        self.claims.given_up.fill(false);
        let is_home: Vec<bool> = self.crew.agents.iter().map(|a| a.activity == Activity::Home).collect();
        let takes_part = |robot: &KnownRobot| robot.is_able() && is_home[robot.id.index()];
        let mut restocked = Vec::new();
        for robot in scene.beliefs.team.iter_mut().filter(|robot| takes_part(robot)) {
            if robot.restock() {
                restocked.push(robot.id);
                scene.log.push(Event::Restocked { robot: robot.id, resources: robot.resources });
            }
            self.crew.agents[robot.id.index()].levels_at_start = Some([robot.energy, robot.hp]);
        }
        self.with_telemetry(scene, Telemetry::ask_at_home);
        if let Some(telemetry) = scene.telemetry.as_deref_mut() {
            telemetry.close_round(scene.beliefs.ledger.rounds(), scene.model, scene.step);
            telemetry.note_question(self.round);
        }
        let telemetry = scene.telemetry.as_deref();
        let as_judged = |robot: &KnownRobot| match (telemetry, &scene.model.telemetry) {
            (Some(telemetry), Some(rules)) if rules.fitness == LevelSource::Reports => {
                robot.with_levels(telemetry.levels(rules, robot.id))
            }
            _ => (**robot).clone(),
        };
        let (mut fit, mut unfit) = (Vec::new(), Vec::new());
        let tasks = self.crew.groups.len() as u16;
        for robot in scene.beliefs.team.iter().filter(|robot| takes_part(robot)) {
            let agent = &self.crew.agents[robot.id.index()];
            match self.crew.unfit_cause(&scene.model.mission, &as_judged(robot)) {
                None => fit.push(robot),
                Some(_) if agent.has_given_up_all_rests(tasks) => {} // it stays home this time
                Some(cause) => unfit.push((robot.id, cause)),
            }
        }
        let member = |robot: &&KnownRobot| match telemetry {
            Some(telemetry) => telemetry.member(robot, scene.model),
            None => robot.member(&scene.model.needs),
        };
        let members = fit.iter().filter_map(member).collect();
        let question = question(scene.model, self.round, scene.beliefs.of(None), members);
        self.crew.agents.iter_mut().for_each(|agent| agent.rests_given_up = 0);
        let is_empty = question.members.is_empty();
        self.pending = Some(Pending { question, unfit });
        if is_empty {
            self.assign(&Assignment::new(vec![Vec::new(); self.crew.groups.len()]), scene);
        }
        restocked
    }

    /// Sends the groups out, and the unfit robots to rest. The assignment must answer the question that waits
    /// for one.
    pub fn assign(&mut self, assignment: &Assignment, scene: &mut Scene) {
        let Some(Pending { unfit, .. }) = self.pending.take() else { return };
        let ids = |group: &Vec<u32>| group.iter().map(|id| RobotId(*id)).collect::<Vec<_>>();
        let groups: Vec<Vec<RobotId>> = assignment.groups.iter().map(ids).collect();
        if let Some(telemetry) = scene.telemetry.as_deref_mut() {
            telemetry.begin_round(&groups);
        }
        scene.beliefs.ledger.begin(self.round, &groups, scene.step as f64 * scene.model.dt_s());
        scene.log.push(Event::RoundStarted { round: self.round, groups: groups.clone() });
        for (task, members) in scene.model.task_ids().zip(groups) {
            let holders = Holder::all_in(scene.model.mission.belief_sharing, task, &members);
            holders.for_each(|holder| scene.beliefs.depart(holder));
            self.crew.send_out(task, members, scene.model, &scene.beliefs.team);
        }
        unfit.iter().for_each(|(id, cause)| self.crew.send_to_rest(*id, *cause, scene));
        self.crew.look_for_guides(&scene.model.mission, &scene.beliefs.team);
    }
}
