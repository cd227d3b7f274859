//! Claims on rescuees. All robots that look for work in a step see the same snapshot. The nearest pairs are
//! settled first, whatever the robots' ids.

use parry2d::math::Vector;
use scenario::ClaimRule;
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;
use teaming::TaskId;

use super::heard_claims::HeardClaims;
use super::{Crew, Scene};
use crate::belief::Holder;
use crate::ids::{RescueeId, RobotId};
use crate::model::Model;

/// New claims: which robot claims which rescuee. The list lives on the stack in teams and tasks of usual
/// size, like all that claims need.
pub(super) type NewClaims = SmallVec<[(RobotId, RescueeId); 16]>;

/// The claims that hold: for each rescuee, the robot that is on its way to it or is loading it.
#[derive(Serialize, Deserialize)]
pub struct Claims {
    by: Vec<Option<RobotId>>,
    changes: u64,
    /// For each rescuee, whether its group gave up on it in this round.
    pub(super) given_up: Vec<bool>,
    /// What each robot knows of claims, where they are told by radio; nothing otherwise.
    pub(super) heard: Vec<HeardClaims>,
}

impl Claims {
    pub(super) fn nothing(model: &Model) -> Self {
        let rescuees = model.rescuee_numbers();
        let told = if model.mission.claims == ClaimRule::Known { 0 } else { model.robots.len() };
        let heard = vec![HeardClaims::default(); told];
        Self { by: vec![None; rescuees], changes: 0, given_up: vec![false; rescuees], heard }
    }

    /// What robots know of claims, where they are told by radio: a part of the hash chain.
    pub fn heard(&self) -> Option<impl Serialize + '_> {
        (!self.heard.is_empty()).then_some(&self.heard)
    }

    /// A robot gives up on a rescuee, and so does its group once it knows.
    pub(super) fn give_up(&mut self, rescuee: RescueeId, robot: RobotId) {
        self.given_up[rescuee.index()] = true;
        if let Some(heard) = self.heard.get_mut(robot.index()) {
            heard.give_up(rescuee);
        }
    }

    /// A round begins: nothing is given up, and nobody knows of a claim.
    pub(super) fn begin_round(&mut self, step: u64) {
        self.given_up.fill(false);
        self.heard.fill(HeardClaims::since(step));
    }

    /// Whether a rescuee is free, as far as a robot knows.
    fn is_free(&self, rescuee: RescueeId, robot: RobotId, step: u64) -> bool {
        match self.heard.get(robot.index()) {
            Some(heard) => heard.is_free(rescuee, step),
            None => self.by[rescuee.index()].is_none() && !self.given_up[rescuee.index()],
        }
    }

    /// The claims without what is given up: a part of the hash chain.
    pub fn held(&self) -> impl Serialize + use<> {
        let claimed = self.by.iter().enumerate().filter_map(|(rescuee, by)| Some((rescuee, (*by)?)));
        (claimed.collect::<SmallVec<[_; 16]>>(), self.changes)
    }

    /// Whether a rescuee's group gave up on it in this round, because it knows no way there or came no
    /// nearer.
    pub fn has_given_up(&self, rescuee: RescueeId) -> bool {
        self.given_up[rescuee.index()]
    }

    /// The robot that claims a rescuee.
    pub fn by(&self, rescuee: RescueeId) -> Option<RobotId> {
        self.by[rescuee.index()]
    }

    /// Number of claims made and given up so far.
    pub fn changes(&self) -> u64 {
        self.changes
    }

    /// A robot claims a rescuee no longer. Another that claims it too keeps its claim.
    pub(super) fn free(&mut self, rescuee: RescueeId, robot: RobotId) {
        if self.by(rescuee).is_none_or(|by| by == robot) || self.heard.is_empty() {
            self.set(rescuee, None);
        }
    }

    pub(super) fn set(&mut self, rescuee: RescueeId, robot: Option<RobotId>) {
        self.by[rescuee.index()] = robot;
        self.changes += 1;
    }
}

/// A rescuee on offer, in whose belief, and where it is believed to wait.
pub(super) struct Offer {
    holder: Holder,
    rescuee: RescueeId,
    at: Vector,
}

impl Offer {
    /// The square of its distance from a place, and the rescuee.
    pub(super) fn from(&self, place: Vector) -> (f32, RescueeId) {
        ((self.at - place).length_squared(), self.rescuee)
    }
}

/// A robot that looks for work, and the nearest rescuee still on offer.
pub(super) struct Seeker {
    robot: RobotId,
    at: Vector,
    holder: Holder,
    nearest: Option<(f32, RescueeId)>,
}

impl Seeker {
    pub(super) fn new(robot: RobotId, at: Vector, holder: Holder, offers: &[Offer]) -> Self {
        let mut seeker = Self { robot, at, holder, nearest: None };
        seeker.look(offers);
        seeker
    }

    /// The nearest rescuee on offer, with the square of its distance.
    pub(super) fn nearest(&self) -> Option<(f32, RescueeId)> {
        self.nearest
    }

    /// Finds the nearest of the rescuees on offer; among equally near rescuees, the one with the lowest id.
    fn look(&mut self, offers: &[Offer]) {
        let own = offers.iter().filter(|offer| offer.holder == self.holder);
        let offers = own.map(|offer| offer.from(self.at));
        self.nearest = offers.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }
}

impl Claims {
    /// The claims that are made in this step, by robot. Each group makes at most as many claims as there are
    /// rescuees and spare resources.
    pub(super) fn new_claims(&self, crew: &Crew, scene: &Scene) -> NewClaims {
        let mut claims = NewClaims::new();
        for task in scene.model.task_ids().filter(|task| crew.groups[task.index()].at_work) {
            self.settle(task, crew, scene, &mut claims);
        }
        claims.sort_unstable();
        claims
    }

    fn settle(&self, task: TaskId, crew: &Crew, scene: &Scene, claims: &mut NewClaims) {
        let members = crew.groups[task.index()].members.iter().copied();
        let mut seeking = members.filter(|id| crew.looks_for_work(*id, scene)).peekable();
        if seeking.peek().is_none() {
            return;
        }
        let spare = crew.spare_resources(task, &scene.beliefs.team);
        if spare <= 0 {
            return;
        }
        let holder = |id: RobotId| Holder::of(scene.model.mission.belief_sharing, id, task);
        let seeking: SmallVec<[RobotId; 16]> = seeking.collect();
        let mut holders: SmallVec<[(Holder, RobotId); 16]> =
            seeking.iter().map(|id| (holder(*id), *id)).collect();
        holders.dedup_by_key(|(holder, _)| *holder);
        let mut offers: SmallVec<[Offer; 256]> = SmallVec::new();
        for (holder, robot) in holders {
            offers.extend(self.on_offer(task, holder, robot, scene));
        }
        if offers.is_empty() {
            return;
        }
        let place = |id: RobotId| scene.place_said(id);
        let mut seekers: SmallVec<[Seeker; 16]> =
            seeking.into_iter().map(|id| Seeker::new(id, place(id), holder(id), &offers)).collect();
        for _ in 0..spare {
            let pairs = seekers.iter().enumerate().filter_map(|(at, seeker)| Some((seeker.nearest?, at)));
            // Seekers are in order of their ids: among equally near ones, the first is taken.
            let Some(((_, rescuee), at)) = pairs.min_by(|a, b| a.0.0.total_cmp(&b.0.0)) else { return };
            claims.push((seekers.remove(at).robot, rescuee));
            offers.retain(|offer| offer.rescuee != rescuee);
            let losers =
                seekers.iter_mut().filter(|seeker| seeker.nearest.is_some_and(|(_, id)| id == rescuee));
            losers.for_each(|seeker| seeker.look(&offers));
        }
    }

    /// Rescuees of a task that are believed to wait, with their places: those that no robot has claimed and
    /// that are not given up as unreachable, as far as a robot knows.
    pub(super) fn on_offer<'s>(
        &'s self,
        task: TaskId,
        holder: Holder,
        robot: RobotId,
        scene: &'s Scene,
    ) -> impl Iterator<Item = Offer> + use<'s> {
        let belief = scene.beliefs.of(Some(holder));
        let names = scene.model.names_of(task).map(|names| belief.waiting_among(&names));
        let offer = move |(rescuee, at): &(RescueeId, Vector)| Offer { holder, rescuee: *rescuee, at: *at };
        names.into_iter().flatten().filter(move |(id, _)| self.is_free(*id, robot, scene.step)).map(offer)
    }
}
