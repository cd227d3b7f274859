//! Claims on rescuees. All robots that look for work in a step see the same snapshot. The nearest pairs are
//! settled first, whatever the robots' ids.

use parry2d::math::Vector;
use rne_core::TaskId;
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use super::{Activity, Mission, Scene};
use crate::ids::{RescueeId, RobotId};
use crate::model::SENSING_PERIOD_STEPS;
use crate::robot::Robot;

/// Which robot claims which rescuee. The list lives on the stack in teams and tasks of usual size, like all
/// that claims need.
pub(super) type Claims = SmallVec<[(RobotId, RescueeId); 16]>;

/// The claims that hold: for each rescuee, the robot that is on its way to it or is loading it.
#[derive(Serialize, Deserialize)]
pub struct Claimed {
    by: Vec<Option<RobotId>>,
    changes: u64,
}

impl Claimed {
    pub(super) fn nothing(rescuees: usize) -> Self {
        Self { by: vec![None; rescuees], changes: 0 }
    }

    /// The robot that claims a rescuee.
    #[must_use]
    pub fn by(&self, rescuee: RescueeId) -> Option<RobotId> {
        self.by[rescuee.index()]
    }

    /// Number of claims made and given up so far.
    #[must_use]
    pub fn changes(&self) -> u64 {
        self.changes
    }

    pub(super) fn set(&mut self, rescuee: RescueeId, robot: Option<RobotId>) {
        self.by[rescuee.index()] = robot;
        self.changes += 1;
    }
}

/// A rescuee on offer, and where it is believed to wait.
type Offer = (RescueeId, Vector);

/// A robot that looks for work, and the nearest rescuee still on offer.
struct Seeker {
    robot: RobotId,
    at: Vector,
    nearest: Option<(f32, RescueeId)>,
}

impl Seeker {
    fn new(robot: RobotId, at: Vector, offers: &[Offer]) -> Self {
        let mut seeker = Self { robot, at, nearest: None };
        seeker.look(offers);
        seeker
    }

    /// Finds the nearest of the rescuees on offer; among equally near rescuees, the one with the lowest id.
    fn look(&mut self, offers: &[Offer]) {
        let offers = offers.iter().map(|(id, place)| ((*place - self.at).length_squared(), *id));
        self.nearest = offers.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }
}

impl Mission {
    /// The claims of this step, by robot. Each group makes at most as many claims as there are rescuees and
    /// spare resources.
    pub(super) fn claims(&self, scene: &Scene) -> Claims {
        let mut claims = Claims::new();
        for task in scene.model.task_ids().filter(|task| self.groups[task.index()].at_work) {
            self.settle_claims(task, scene, &mut claims);
        }
        claims.sort_unstable();
        claims
    }

    fn settle_claims(&self, task: TaskId, scene: &Scene, claims: &mut Claims) {
        let members = self.groups[task.index()].members.iter().copied();
        let mut seeking = members.filter(|id| self.looks_for_work(*id, scene)).peekable();
        if seeking.peek().is_none() {
            return;
        }
        let spare = self.spare_resources(task, &scene.beliefs.team);
        if spare <= 0 {
            return;
        }
        let mut offers: SmallVec<[Offer; 256]> = self.available(task, scene).collect();
        if offers.is_empty() {
            return;
        }
        let place = |id: RobotId| scene.beliefs.team[id.index()].position;
        let mut seekers: SmallVec<[Seeker; 16]> =
            seeking.map(|id| Seeker::new(id, place(id), &offers)).collect();
        for _ in 0..spare {
            let pairs = seekers.iter().enumerate().filter_map(|(at, seeker)| Some((seeker.nearest?, at)));
            // Seekers are in order of their ids: among equally near ones, the first is taken.
            let Some(((_, rescuee), at)) = pairs.min_by(|a, b| a.0.0.total_cmp(&b.0.0)) else { return };
            claims.push((seekers.remove(at).robot, rescuee));
            offers.retain(|(offer, _)| *offer != rescuee);
            let losers =
                seekers.iter_mut().filter(|seeker| seeker.nearest.is_some_and(|(_, id)| id == rescuee));
            losers.for_each(|seeker| seeker.look(&offers));
        }
    }

    /// Whether a robot may claim a rescuee in this step. Robots take turns, so that not all of them search in
    /// the same step.
    fn looks_for_work(&self, id: RobotId, scene: &Scene) -> bool {
        let robot = &scene.beliefs.team[id.index()];
        let is_free = matches!(self.agents[id.index()].activity, Activity::Searching | Activity::Standby);
        let is_due = (scene.step + u64::from(id.0)).is_multiple_of(SENSING_PERIOD_STEPS);
        is_due && is_free && robot.is_able() && robot.free_capacity() > 0
    }

    /// Rescuees that a group believes to wait, with their places: those that no robot has claimed and that are
    /// not given up as unreachable.
    pub(super) fn available<'s>(
        &'s self,
        task: TaskId,
        scene: &'s Scene,
    ) -> impl Iterator<Item = (RescueeId, Vector)> + use<'s> {
        let believed = &scene.beliefs.of(Some(task)).rescuees;
        let is_free = |i: &usize| self.claimed.by[*i].is_none() && !self.unreachable[*i];
        let waiting = move |i: usize| Some((RescueeId(i as u32), believed.get(i)?.waits_at?));
        scene.model.tasks[task.index()].rescuees.clone().filter(is_free).filter_map(waiting)
    }

    /// Resources of a group in the field that no claim needs; negative if there are more claims than
    /// resources.
    fn spare_resources(&self, task: TaskId, team: &[Robot]) -> i64 {
        let resources = |id: RobotId| i64::from(team[id.index()].resources);
        let claims = |id: RobotId| i64::from(self.agents[id.index()].activity.claim().is_some());
        self.in_field(task, team).map(|id| resources(id) - claims(id)).sum()
    }
}
