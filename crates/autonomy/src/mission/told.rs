//! Claims by radio: each robot knows its own claim and those that it heard of. Of two on one rescuee the
//! nearer robot keeps its claim, then the one with the lower id; who does not hear of another goes on.

use std::collections::BTreeMap;

use scenario::ClaimRule;

use super::claims::{NewClaims, Offer, Seeker};
use super::heard_claims::Heard;
use super::{Activity, Mission, Scene};
use crate::belief::Holder;
use crate::ids::RobotId;
use crate::report::{Claim, Message, Report, Speaker, Statement};
use crate::telemetry::in_turn;

/// A claim that was not heard again for this many times the time between two tellings counts no longer.
const LAPSE: u64 = 3;

/// Where a claim stands among others on the same rescuee, or on the same resources: the lowest counts most.
fn rank(claim: &Claim, by: RobotId) -> impl Ord + use<> {
    // Distances are finite and not negative, so that their bits are in their order.
    (claim.squared_m.to_bits(), by)
}

impl Mission {
    /// The claims that robots make in this step. Where all is heard at once, they are those that the group
    /// would make together: pass by pass each takes the nearest that it holds for free and tells its mates,
    /// until nobody has heard of a better claim than its own. Each makes only a claim for which, as it knows,
    /// there is a resource.
    pub(super) fn claim_by_radio(&mut self, scene: &mut Scene) -> NewClaims {
        let mut new: BTreeMap<RobotId, Claim> = BTreeMap::new();
        let mut lost: Vec<RobotId> = Vec::new();
        for _ in 0..=scene.beliefs.team.len() {
            let tried = self.try_claims(&new, scene);
            lost.retain(|robot| tried.iter().all(|(by, _)| by != robot));
            if tried.is_empty() && lost.is_empty() {
                break;
            }
            for robot in std::mem::take(&mut lost) {
                self.tell_claim(robot, None, scene);
            }
            for (robot, claim) in tried {
                self.tell_claim(robot, Some(claim), scene);
                new.insert(robot, claim);
            }
            self.hear_mates(scene);
            lost.extend(new.extract_if(.., |robot, claim| self.is_bettered(*robot, claim)).map(|it| it.0));
        }
        let beyond: Vec<RobotId> = new
            .iter()
            .filter(|(robot, claim)| !self.has_resource(**robot, claim, scene))
            .map(|it| *it.0)
            .collect();
        beyond.iter().for_each(|robot| {
            new.remove(robot);
        });
        let mut claims: NewClaims = new.into_iter().map(|(robot, claim)| (robot, claim.rescuee)).collect();
        claims.sort_unstable();
        claims
    }

    /// The nearest rescuee on offer of each robot that looks for work and has none.
    fn try_claims(&self, new: &BTreeMap<RobotId, Claim>, scene: &Scene) -> Vec<(RobotId, Claim)> {
        let mut tried = Vec::new();
        for task in scene.model.task_ids().filter(|task| self.crew.groups[task.index()].at_work) {
            let members = self.crew.groups[task.index()].members.iter();
            for robot in members.filter(|id| !new.contains_key(id) && self.crew.looks_for_work(**id, scene)) {
                let holder = Holder::of(scene.model.mission.belief_sharing, *robot, task);
                let (at, since_step) = (scene.place_said(*robot), scene.step);
                let claim = |(squared_m, rescuee)| Claim { rescuee, squared_m, since_step };
                let is_open = |offer: &Offer| !self.is_bettered(*robot, &claim(offer.from(at)));
                let offers = self.claims.on_offer(task, holder, *robot, scene).filter(is_open);
                let seeker = Seeker::new(*robot, at, holder, &offers.collect::<Vec<_>>());
                let Some(claim) = seeker.nearest().map(claim) else { continue };
                if self.has_resource(*robot, &claim, scene) {
                    tried.push((*robot, claim));
                }
            }
        }
        tried
    }

    /// Whether a robot has heard of a better claim on the same rescuee than its own.
    fn is_bettered(&self, robot: RobotId, own: &Claim) -> bool {
        self.claims.heard[robot.index()]
            .claims()
            .any(|(by, claim)| claim.rescuee == own.rescuee && rank(claim, by) < rank(own, robot))
    }

    /// Whether the group has a resource for a claim, as its robot knows: claims that were made before, or in
    /// the same step by nearer robots, come first.
    fn has_resource(&self, robot: RobotId, own: &Claim, scene: &Scene) -> bool {
        let Some(task) = self.crew.group_of(robot) else { return false };
        let is_before = |(by, claim): &(RobotId, &Claim)| {
            let is_earlier = claim.since_step < own.since_step
                || claim.since_step == own.since_step && rank(claim, *by) < rank(own, robot);
            is_earlier && !scene.is_known_gone(robot, task, claim.rescuee)
        };
        let claimed = self.claims.heard[robot.index()].claims().filter(is_before).count();
        (claimed as u64) < u64::from(self.crew.resources_in_field(task, &scene.beliefs.team))
    }

    /// Robots tell their mates what they claim now and what they gave up, where that is new, and again from
    /// time to time.
    pub(super) fn tell_claims(&mut self, scene: &mut Scene) {
        let ClaimRule::ByRadio { again_s } = scene.model.mission.claims else { return };
        let again = scene.model.steps_in(again_s).max(1);
        for robot in self.in_turn(scene) {
            let place = robot.index();
            let lapsed = |heard: &Heard| heard.heard_at + LAPSE * again <= scene.step;
            self.claims.heard[place].mates.retain(|_, heard| !lapsed(heard));
            if !scene.beliefs.team[place].is_able() {
                continue; // a lost robot tells nothing
            }
            for rescuee in std::mem::take(&mut self.claims.heard[place].untold) {
                self.tell_mates(robot, Statement::GivesUp { rescuee }, scene);
            }
            let heard = &self.claims.heard[place];
            let now = self.claim_of(robot, scene);
            let is_new = now.map(|claim| claim.rescuee) != heard.told.map(|(claim, _)| claim.rescuee);
            let is_due = heard.tells_again || heard.told.is_some_and(|(_, step)| step + again <= scene.step);
            if is_new || is_due && now.is_some() {
                self.tell_claim(robot, now, scene);
            }
        }
    }

    /// The claim of a robot as it is now.
    fn claim_of(&self, robot: RobotId, scene: &Scene) -> Option<Claim> {
        let (agent, told) = (&self.crew.agents[robot.index()], self.claims.heard[robot.index()].told);
        let rescuee = agent.activity.claim().filter(|_| scene.beliefs.team[robot.index()].is_able())?;
        let at = scene.place_of(robot, agent.task?, rescuee)?;
        let own = told.map(|(claim, _)| claim).filter(|claim| claim.rescuee == rescuee);
        let since_step = own.map_or(scene.step, |claim| claim.since_step);
        Some(Claim { rescuee, squared_m: (at - scene.place_said(robot)).length_squared(), since_step })
    }

    fn tell_claim(&mut self, robot: RobotId, claim: Option<Claim>, scene: &mut Scene) {
        let heard = &mut self.claims.heard[robot.index()];
        (heard.told, heard.tells_again) = (claim.map(|claim| (claim, scene.step)), false);
        self.tell_mates(robot, Statement::Claims(claim), scene);
    }

    fn tell_mates(&self, robot: RobotId, says: Statement, scene: &mut Scene) {
        let report = Report { from: Speaker::Robot(robot), says, at_step: scene.step, sd_m: 0.0 };
        self.with_telemetry(scene, |telemetry, now, log| {
            telemetry.say_to_mates(&report, self.crew.mates_of(robot), now, log);
        });
    }

    /// Group-mates hear what has arrived by now.
    pub fn hear_mates(&mut self, scene: &mut Scene) {
        let Some(telemetry) = scene.telemetry.as_deref_mut() else { return };
        let time_s = scene.step as f64 * scene.model.dt_s();
        for message in telemetry.heard_by_mates(time_s, scene.log) {
            let Some(to) = message.to else { continue };
            let known = self.claims.heard.get(to.index());
            let is_of_round = known.is_some_and(|known| message.report.at_step >= known.since_step);
            match message.report.says {
                Statement::Claims(_) | Statement::GivesUp { .. } if !is_of_round => {}
                Statement::Claims(claim) => self.hear_claim(to, claim, &message, scene),
                Statement::GivesUp { rescuee } => {
                    self.claims.heard[to.index()].given_up.insert(rescuee);
                }
                _ => {
                    if let Some(holder) = self.crew.holder_of(to, scene.model) {
                        scene.beliefs.hear_in_field(holder, &message.report);
                    }
                }
            }
        }
    }

    /// A robot hears what a mate claims, or that it claims nothing any more. If both are on their way to the
    /// same rescuee, the one that is farther gives its claim up, and the other tells of its own again.
    fn hear_claim(&mut self, to: RobotId, claim: Option<Claim>, message: &Message, scene: &mut Scene) {
        let (by, said_at, heard_at) = (message.sender, message.report.at_step, scene.step);
        let Some(heard) = self.claims.heard.get_mut(to.index()) else { return };
        if heard.mates.get(&by).is_some_and(|known| known.said_at > said_at) {
            return; // it was overtaken
        }
        heard.mates.insert(by, Heard { claim, said_at, heard_at });
        let Some(claim) = claim else { return };
        let is_under_way = self.crew.agents[to.index()].activity == Activity::Approaching(claim.rescuee);
        let Some(own) = self.claim_of(to, scene).filter(|_| is_under_way) else { return };
        if rank(&claim, by) < rank(&own, to) {
            self.release_claim(to);
            self.crew.agent(to).activity = Activity::Searching;
        } else {
            self.claims.heard[to.index()].tells_again = true;
        }
    }

    /// The robots in the order in which they speak.
    pub(super) fn in_turn(&self, scene: &mut Scene) -> Vec<RobotId> {
        let mut order: Vec<RobotId> = scene.beliefs.team.iter().map(|robot| robot.id).collect();
        self.with_telemetry(scene, |_, now, _| {
            order = in_turn(now.team.iter(), now).into_iter().map(|robot| robot.id).collect();
        });
        order
    }
}
