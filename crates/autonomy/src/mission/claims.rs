//! Claims on rescuees. All robots that look for work in a step see the same snapshot. The nearest pairs are
//! settled first, whatever the robots' ids.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;
use teaming::TaskId;

use super::{Crew, Scene};
use crate::belief::Holder;
use crate::ids::{RescueeId, RobotId};

/// New claims: which robot claims which rescuee. The list lives on the stack in teams and tasks of usual
/// size, like all that claims need.
type NewClaims = SmallVec<[(RobotId, RescueeId); 16]>;

/// The claims that hold: for each rescuee, the robot that is on its way to it or is loading it.
#[derive(Serialize, Deserialize)]
pub struct Claims {
    by: Vec<Option<RobotId>>,
    changes: u64,
    /// For each rescuee, whether its group gave up on it in this round.
    pub(super) given_up: Vec<bool>,
}

impl Claims {
    pub(super) fn nothing(rescuees: usize) -> Self {
        Self { by: vec![None; rescuees], changes: 0, given_up: vec![false; rescuees] }
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

/// A robot that looks for work, and the nearest rescuee still on offer.
struct Seeker {
    robot: RobotId,
    at: Vector,
    holder: Holder,
    nearest: Option<(f32, RescueeId)>,
}

impl Seeker {
    fn new(robot: RobotId, at: Vector, holder: Holder, offers: &[Offer]) -> Self {
        let mut seeker = Self { robot, at, holder, nearest: None };
        seeker.look(offers);
        seeker
    }

    /// Finds the nearest of the rescuees on offer; among equally near rescuees, the one with the lowest id.
    fn look(&mut self, offers: &[Offer]) {
        let own = offers.iter().filter(|offer| offer.holder == self.holder);
        let offers = own.map(|offer| ((offer.at - self.at).length_squared(), offer.rescuee));
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
        let mut holders: SmallVec<[Holder; 16]> = seeking.iter().copied().map(holder).collect();
        holders.dedup();
        let mut offers: SmallVec<[Offer; 256]> = SmallVec::new();
        holders.into_iter().for_each(|holder| offers.extend(self.on_offer(task, holder, scene)));
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
    /// that are not given up as unreachable.
    pub(super) fn on_offer<'s>(
        &'s self,
        task: TaskId,
        holder: Holder,
        scene: &'s Scene,
    ) -> impl Iterator<Item = Offer> + use<'s> {
        let belief = scene.beliefs.of(Some(holder));
        let names = scene.model.names_of(task).map(|names| belief.waiting_among(&names));
        let is_free = |id: &RescueeId| self.by[id.index()].is_none() && !self.given_up[id.index()];
        let offer = move |(rescuee, at): &(RescueeId, Vector)| Offer { holder, rescuee: *rescuee, at: *at };
        names.into_iter().flatten().filter(move |(id, _)| is_free(id)).map(offer)
    }
}
