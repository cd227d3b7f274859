//! The watchdog: a robot that comes no nearer gives up on its errand, and the team does not wait for one that
//! comes no nearer to its home or its rest place. As long as one of those for which a robot waits gets on,
//! the robot gives up nothing.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};
use teaming::TaskId;

use super::{Activity, Crew, Scene};
use crate::belief::KnownRobot;
use crate::conflict::Directive;
use crate::event::{CutOffCause, Event};
use crate::ids::RobotId;
use crate::model::{LATE_SHARE, Model};
use crate::robot::RobotState;

/// Least decrease of the remaining route that counts as coming nearer, in metres. A smaller one may be a push
/// by another robot.
const NEARER_M: f32 = 0.5;

/// A robot slower than this, in metres per second, may take in proportion longer to come nearer.
const USUAL_MPS: f64 = 1.0;

/// The progress of a robot towards one goal.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    goal: Option<Vector>,
    /// The shortest remaining route so far, in metres; none before the first route.
    nearest_m: Option<f32>,
    /// The longest remaining route since the robot last came nearer, in metres.
    longest_m: f32,
    /// Steps since the robot last came nearer or stood at its goal. Of a robot that waits for others, no more
    /// than those after which it is late.
    pub held_up_steps: u64,
}

impl Progress {
    /// Notes the length of the remaining route to the goal. Returns whether the robot came nearer.
    fn note(&mut self, goal: Option<Vector>, left_m: Option<f32>) -> bool {
        if self.goal != goal {
            *self = Self { goal, ..Self::default() };
        }
        self.held_up_steps += 1;
        let Some(left_m) = left_m else { return false };
        self.longest_m = self.longest_m.max(left_m);
        let is_nearer = self.nearest_m.is_some_and(|nearest| left_m <= nearest - NEARER_M);
        if is_nearer || self.nearest_m.is_none() {
            *self = Self { goal, nearest_m: Some(left_m), longest_m: left_m, held_up_steps: 0 };
        }
        is_nearer
    }

    /// The distance that the robot may travel before it has to come nearer, in metres: the whole of a detour.
    fn allowed_way_m(&self) -> f32 {
        self.longest_m - self.nearest_m.unwrap_or(self.longest_m) + NEARER_M
    }
}

impl Crew {
    /// Watches the progress of each robot. A robot that cannot get to its rest place tries the next one. The
    /// team does not wait for a robot that cannot get home.
    pub(super) fn note_progress(&mut self, scene: &mut Scene) {
        for id in (0..scene.beliefs.team.len() as u32).map(RobotId) {
            let robot = &scene.beliefs.team[id.index()];
            if !robot.is_able() {
                continue;
            }
            let is_nearer = self.note_way(id, scene);
            let agent = &mut self.agents[id.index()];
            if is_nearer || !agent.activity.is_way_back() {
                agent.is_cut_off = false;
            }
            match agent.activity {
                Activity::ToRest | Activity::Resting(_) => self.watch_way_to_rest(id, scene),
                Activity::Returning | Activity::Home => {
                    if let Some(cause) = self.held_up_cause(id, scene) {
                        let home = scene.beliefs.team[id.index()].home;
                        self.cut_off(id, home, cause, scene);
                    }
                }
                Activity::Searching
                | Activity::Approaching(_)
                | Activity::Loading(..)
                | Activity::Standby
                | Activity::OnErrand => {}
            }
        }
    }

    /// Notes the remaining route of a robot. Returns whether the robot came nearer, has arrived, or has no
    /// goal.
    pub(super) fn note_way(&mut self, id: RobotId, scene: &mut Scene) -> bool {
        let position = scene.beliefs.team[id.index()].position;
        let traveller = scene.navigator.traveller(id);
        let goal = traveller.goal().map(|goal| goal.point);
        if traveller.is_settled_at(position) && self.agents[id.index()].progress.goal == goal {
            return true; // nothing has changed since it was noted last
        }
        let late_steps = self.late_while_others_get_on(id, scene);
        let (left_m, is_there) = scene.navigator.way_left(id, position);
        let progress = &mut self.agents[id.index()].progress;
        progress.held_up_steps = late_steps.unwrap_or(progress.held_up_steps);
        let is_nearer = progress.note(goal, left_m);
        if is_there {
            progress.held_up_steps = 0;
        }
        is_nearer || is_there
    }

    /// The steps after which a robot is late, if it is and a robot for which it waits is not, or one for
    /// which that robot waits, and so on.
    fn late_while_others_get_on(&self, id: RobotId, scene: &Scene) -> Option<u64> {
        let (team, model) = (&scene.beliefs.team, scene.model);
        let is_late = |robot: &KnownRobot| self.is_held_up_for(LATE_SHARE, robot, model);
        if !is_late(&team[id.index()]) {
            return None;
        }
        let gets_on = |id: RobotId| {
            let (robot, activity) = (&team[id.index()], self.agents[id.index()].activity);
            let is_under_way = !matches!(activity, Activity::Standby | Activity::Home);
            let has_arrived = || scene.navigator.traveller(id).has_arrived(robot.position);
            is_under_way && robot.is_able() && !has_arrived() && !is_late(robot)
        };
        let waits_for = |id: &RobotId| match scene.directives.get(id.index())? {
            Directive::Retreat { room_for, .. } => Some(*room_for),
            directive => directive.waits_for(),
        };
        let mut ahead = std::iter::successors(waits_for(&id), waits_for).take(team.len());
        ahead.any(gets_on).then(|| self.patience(LATE_SHARE, &team[id.index()], model))
    }

    /// Whether a robot has come no nearer to its goal for `mission.cut_off_s` plus the time that its longest
    /// detour takes.
    pub(super) fn is_held_up(&self, robot: &RobotState, model: &Model) -> bool {
        self.is_held_up_for(1.0, robot, model)
    }

    /// The same for so many times `mission.cut_off_s`.
    fn is_held_up_for(&self, times: f64, robot: &RobotState, model: &Model) -> bool {
        let steps = self.agents[robot.id.index()].progress.held_up_steps;
        steps > model.mission.late_steps && steps > self.patience(times, robot, model)
    }

    /// So many times `mission.cut_off_s`, longer for a slow robot, plus the time that its longest detour
    /// takes, in control steps.
    fn patience(&self, times: f64, robot: &RobotState, model: &Model) -> u64 {
        let speed = self.speed_of(model, robot).max(1e-6);
        let detour_s = f64::from(self.agents[robot.id.index()].progress.allowed_way_m()) / speed;
        let seconds = times * model.mission.cut_off_s * (USUAL_MPS / speed).max(1.0);
        model.control_steps_in(seconds + detour_s)
    }

    /// Number of the robots that can act and stand, as far as the watchdog can tell: they have something to
    /// do, and do not get there.
    pub fn stalled<'r>(&self, robots: impl Iterator<Item = &'r RobotState>, model: &Model) -> u32 {
        let stands = |robot: &&RobotState| {
            let agent = &self.agents[robot.id.index()];
            let is_held_up = || agent.activity != Activity::Standby && self.is_held_up(robot, model);
            robot.is_able() && (agent.is_cut_off || is_held_up())
        };
        robots.filter(stands).count() as u32
    }

    /// Whether nothing can happen any more in a mission: no round can begin, no event is to come, and no
    /// robot gets anywhere.
    pub(super) fn is_at_a_standstill(&self, scene: &Scene) -> bool {
        !scene.awaits_event && self.all_stay(scene) && !self.can_begin_round(scene)
    }

    /// Whether every robot that can act is at home, or has been cut off and come no nearer for as long again.
    pub(super) fn all_stay(&self, scene: &Scene) -> bool {
        let stays = |robot: &KnownRobot| {
            let (agent, model) = (&self.agents[robot.id.index()], scene.model);
            let is_home = || scene.navigator.traveller(robot.id).has_arrived(robot.position);
            match agent.activity {
                Activity::Home if is_home() => true,
                _ => agent.is_cut_off && self.is_held_up_for(2.0, robot, model),
            }
        };
        scene.beliefs.team.iter().filter(|robot| robot.is_able()).all(stays)
    }

    /// Why a robot cannot get to its goal; `None` if it has arrived or still makes progress.
    pub(super) fn held_up_cause(&self, id: RobotId, scene: &Scene) -> Option<CutOffCause> {
        let robot = &scene.beliefs.team[id.index()];
        if scene.navigator.traveller(id).has_arrived(robot.position) {
            None
        } else if scene.gives_up(id) {
            Some(CutOffCause::NoWay)
        } else if self.is_held_up(robot, scene.model) {
            Some(CutOffCause::NoProgress)
        } else {
            None
        }
    }

    /// Gives up on a rest place if a robot cannot get to its slot there, and sends the robot to the next rest
    /// place; after the last one, home.
    fn watch_way_to_rest(&mut self, id: RobotId, scene: &mut Scene) {
        let (robot, traveller) = (&scene.beliefs.team[id.index()], scene.navigator.traveller(id));
        let agent = &self.agents[id.index()];
        let slot = robot.rest_slot(agent.rest_at);
        let is_for_slot = traveller.goal().is_some_and(|goal| goal.point == slot);
        let is_beside_slot = traveller.has_arrived(robot.position) && !scene.is_at_place(robot);
        let cause = if is_beside_slot { Some(CutOffCause::NoWay) } else { self.held_up_cause(id, scene) };
        let Some(cause) = cause.filter(|_| is_for_slot) else { return };
        self.give_up(id, slot, cause, scene);
        let agent = &mut self.agents[id.index()];
        agent.rests_given_up |= 1 << agent.rest_at.0;
        let tasks = self.groups.len() as u16;
        let mut others = (1..tasks).map(|step| TaskId((agent.rest_at.0 + step) % tasks));
        match others.find(|task| !agent.has_given_up_rest(*task)) {
            Some(next) => agent.rest_at = next,
            None => agent.activity = Activity::Returning,
        }
    }

    /// A robot gives up on a place: because it knows no way, or because it comes no nearer.
    pub(super) fn give_up(&mut self, id: RobotId, place: Vector, cause: CutOffCause, scene: &mut Scene) {
        match cause {
            CutOffCause::NoWay => scene.log.push(Event::Unreachable { robot: id, place: place.into() }),
            CutOffCause::NoProgress => self.cut_off(id, place, cause, scene),
        }
    }

    /// Marks a robot for which nobody waits until it comes nearer. Logs this once.
    pub(super) fn cut_off(&mut self, id: RobotId, place: Vector, cause: CutOffCause, scene: &mut Scene) {
        if !std::mem::replace(&mut self.agents[id.index()].is_cut_off, true) {
            scene.log.push(Event::CutOff { robot: id, place: place.into(), cause });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coming_nearer_counts_and_driving_to_and_fro_does_not() {
        let goal = Some(Vector::ZERO);
        let mut progress = Progress::default();
        assert!(!progress.note(goal, Some(20.0)), "the first route");
        assert!(!progress.note(goal, Some(19.8)) && progress.note(goal, Some(19.5)));
        for _ in 0..10 {
            assert!(
                !progress.note(goal, Some(40.0))
                    && !progress.note(goal, Some(19.4))
                    && !progress.note(goal, None)
            );
        }
        assert_eq!(progress.held_up_steps, 30);
        assert!((progress.allowed_way_m() - 21.0).abs() < 1e-6, "the detour from 19.5 m to 40 m and back");
        assert!(!progress.note(Some(Vector::X), Some(90.0)), "another goal");
        assert_eq!(progress.held_up_steps, 0);
    }
}
