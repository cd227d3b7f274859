//! Between rounds: the end of one, the opening of the next, and the departure of the groups.

use scenario::{Decider, LevelSource};
use teaming::{Assignment, Question};

use super::question::question;
use super::{Activity, Gathered, Join, Mission, Pending, Scene, Talks};
use crate::belief::KnownRobot;
use crate::belief::{Beliefs, Holder};
use crate::event::{Event, EventLog};
use crate::ids::RobotId;
use crate::telemetry::{Now, Telemetry, seed_of};

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
        if let Some(round) = scene.beliefs.ledger.rounds().last().cloned() {
            self.with_telemetry(scene, |telemetry, now, log| telemetry.tell_rounds(&round, now, log));
        }
        for (agent, robot) in self.crew.agents.iter_mut().zip(&scene.beliefs.team) {
            agent.task = None;
            if let Some([energy, hp]) = agent.levels_at_start {
                let [most_energy, most_hp] = agent.costliest_round;
                agent.costliest_round = [most_energy.max(energy - robot.energy), most_hp.max(hp - robot.hp)];
            }
        }
    }

    /// Restocks the robots at home, which say how they are. Where the base decides, it asks at once how the
    /// fit ones are to be grouped; where robots do, they talk first. Returns the robots that the base
    /// restocks; it knows what it hands out.
    pub(super) fn open_round(&mut self, scene: &mut Scene) -> Vec<RobotId> {
        self.round += 1;
        self.claims.begin_round(scene.step);
        let mut restocked = Vec::new();
        for id in self.at_home(&scene.beliefs.team) {
            let robot = &mut scene.beliefs.team[id.index()];
            if robot.restock() {
                restocked.push(id);
                scene.log.push(Event::Restocked { robot: id, resources: robot.resources });
            }
            self.crew.agent(id).levels_at_start = Some([robot.energy, robot.hp]);
        }
        self.with_telemetry(scene, Telemetry::ask_at_home);
        if let Some(telemetry) = scene.telemetry.as_deref_mut() {
            telemetry.close_round(scene.beliefs.ledger.rounds(), scene.model, scene.step);
        }
        let who = self.gathered(scene);
        match scene.model.mission.decides {
            Decider::Base => self.ask(who, scene),
            Decider::Robots { .. } if who.fit.is_empty() => self.ask(who, scene),
            Decider::Robots { .. } => {
                let out: Vec<RobotId> = who.home.iter().filter(|id| !who.fit.contains(id)).copied().collect();
                self.with_telemetry(scene, |telemetry, now, log| telemetry.tell_who_stays(&out, now, log));
                self.talks = Some(Talks::begin(who, scene.step));
                self.talk(scene);
            }
        }
        restocked
    }

    /// The robots at home that can act.
    fn at_home(&self, team: &[KnownRobot]) -> Vec<RobotId> {
        let is_home = |robot: &&KnownRobot| {
            robot.is_able() && self.crew.agents[robot.id.index()].activity == Activity::Home
        };
        team.iter().filter(is_home).map(|robot| robot.id).collect()
    }

    /// The robots at home, those of them that take part in the round, and those that must rest. The base
    /// judges them by what it knows of them, and a robot itself by how it is.
    fn gathered(&self, scene: &Scene) -> Gathered {
        let (telemetry, mission) = (scene.telemetry.as_deref(), &scene.model.mission);
        let as_judged = |robot: &KnownRobot| match (telemetry, &scene.model.telemetry) {
            (Some(telemetry), Some(rules))
                if rules.fitness == LevelSource::Reports && mission.decides.is_base() =>
            {
                robot.with_levels(telemetry.levels(rules, robot.id))
            }
            _ => (**robot).clone(),
        };
        let home = self.at_home(&scene.beliefs.team);
        let (mut fit, mut unfit) = (Vec::new(), Vec::new());
        let tasks = self.crew.groups.len() as u16;
        for id in home.iter().copied() {
            let agent = &self.crew.agents[id.index()];
            match self.crew.unfit_cause(mission, &as_judged(&scene.beliefs.team[id.index()])) {
                None => fit.push(id),
                Some(_) if agent.has_given_up_all_rests(tasks) => {} // it stays home this time
                Some(cause) => unfit.push((id, cause)),
            }
        }
        Gathered { home, fit, unfit }
    }

    /// Asks how the fit robots are to be grouped. If no robot is fit, assigns empty groups without a
    /// question.
    fn ask(&mut self, who: Gathered, scene: &mut Scene) {
        self.note_question(true, scene);
        let question = self.question_of(None, &who, scene);
        let is_empty = question.members.is_empty();
        self.pending = Some(Pending { question, turns: Vec::new(), unfit: who.unfit });
        if is_empty {
            self.assign(&Assignment::new(vec![Vec::new(); self.crew.groups.len()]), &[], scene);
        }
    }

    /// The question of the base about the fit robots, or that of a robot about those at home of which it does
    /// not know that they stay out. Whom it never heard is a member like any other of its role.
    pub(super) fn question_of(&self, asker: Option<RobotId>, who: &Gathered, scene: &Scene) -> Question {
        let (model, team) = (scene.model, &scene.beliefs.team);
        let telemetry = scene.telemetry.as_deref();
        let present = match (asker, telemetry) {
            (Some(asker), Some(telemetry)) => {
                let is_out = |id: &RobotId| *id != asker && telemetry.knows_out(asker, *id, self.round);
                who.home.iter().copied().filter(|id| !is_out(id)).collect()
            }
            _ => who.fit.clone(),
        };
        let member = |id: &RobotId| match telemetry {
            Some(telemetry) => telemetry.member(asker, &team[id.index()], model),
            None => team[id.index()].member(&model.needs),
        };
        let members = present.iter().filter_map(member).collect();
        let mut question = question(model, self.round, scene.beliefs.of(None), members);
        if let Some(asker) = asker {
            question.asker = Some(asker.0);
            question.random_seed = seed_of(model, self.round, asker, question.random_seed);
        }
        question
    }

    /// Sends the groups out, and the unfit robots to rest. The assignment must answer the question that waits
    /// for one, or be what came of these joins of a negotiation, which ends.
    pub fn assign(&mut self, assignment: &Assignment, joins: &[Join], scene: &mut Scene) {
        let Some(Pending { unfit, .. }) = self.pending.take() else { return };
        let robots_decided = self.talks.take().is_some();
        self.crew.agents.iter_mut().for_each(|agent| agent.rests_given_up = 0);
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
        // Who names nobody else looks who goes along.
        for join in joins.iter().filter(|join| join.names_others()) {
            self.crew.share_sweep(RobotId(join.robot), &join.mates(), scene.model, &scene.beliefs.team);
        }
        unfit.iter().for_each(|(id, cause)| self.crew.send_to_rest(*id, *cause, scene));
        if let Decider::Robots { retry_s, .. } = scene.model.mission.decides
            && robots_decided
            && !self.crew.groups.iter().any(|group| group.at_work)
        {
            self.waits_until = scene.step + scene.model.steps_in(retry_s);
        }
        self.crew.look_for_guides(&scene.model.mission, &scene.beliefs.team);
    }
}
