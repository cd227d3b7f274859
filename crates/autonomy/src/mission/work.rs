//! Work in the field: approaching rescuees, the search for more, and the end of a task.

use parry2d::math::Vector;
use teaming::TaskId;

use super::{Activity, Mission, SWEEP_M, Scene};
use crate::event::{CutOffCause, Event};
use crate::ids::{RescueeId, RobotId};

/// A robot that has come no nearer to a place of its sweep for this long, in seconds, leaves it to a member
/// of its group that is there.
const TAKEN_AFTER_S: f64 = 10.0;

impl Mission {
    /// Chooses a robot's next activity, if it is free to choose. `claim` is the rescuee that it may approach,
    /// if there is one.
    pub(super) fn choose_activity(&mut self, id: RobotId, claim: Option<RescueeId>, scene: &mut Scene) {
        let robot = &scene.beliefs.team[id.index()];
        let agent = &self.crew.agents[id.index()];
        let activity = agent.activity;
        let Some(task) = agent.task.filter(|_| robot.is_able()) else { return };
        let is_held_up = activity.is_in_field() && self.crew.is_held_up(robot, scene.model);
        match activity {
            Activity::Approaching(rescuee) => match scene.place_of(id, task, rescuee) {
                Some(at) if is_held_up || is_out_of_reach(id, at, scene) => {
                    self.give_up(id, task, rescuee, scene);
                }
                Some(_) => {}
                None => {
                    // A mate has said since that it is gone.
                    self.release_claim(id);
                    self.crew.agent(id).activity = Activity::Searching;
                }
            },
            Activity::Searching | Activity::Standby => match claim {
                _ if !self.crew.groups[task.index()].at_work => {}
                Some(rescuee) => {
                    self.claims.set(rescuee, Some(id));
                    self.crew.agent(id).activity = Activity::Approaching(rescuee);
                }
                None => self.go_on_searching(id, scene, is_held_up),
            },
            Activity::Home
            | Activity::Loading(..)
            | Activity::OnErrand
            | Activity::Returning
            | Activity::ToRest
            | Activity::Resting(_) => {}
        }
    }

    /// Gives up on a rescuee that cannot be reached, or to which the robot comes no nearer.
    fn give_up(&mut self, id: RobotId, task: TaskId, rescuee: RescueeId, scene: &mut Scene) {
        self.claims.give_up(rescuee, id);
        if let Some(at) = scene.place_of(id, task, rescuee) {
            let (robot, place, cause) = (id, at.into(), CutOffCause::NoProgress);
            let knows_no_way = is_out_of_reach(id, at, scene);
            let cut_off = Event::CutOff { robot, place, cause };
            scene.log.push(if knows_no_way { Event::Unreachable { robot, place } } else { cut_off });
        }
        self.release_claim(id);
        self.crew.agent(id).activity = Activity::Searching;
    }

    /// Whether a robot has come no nearer to the present place of its sweep for a while, and a member of its
    /// group is there.
    fn is_taken(&self, id: RobotId, scene: &Scene) -> bool {
        let agent = &self.crew.agents[id.index()];
        let (Some(place), Some(task)) = (agent.sweep.last(), agent.task) else { return false };
        let is_there = |mate: &RobotId| *mate != id && (scene.place_said(*mate) - *place).length() <= SWEEP_M;
        agent.progress.held_up_steps > scene.model.control_steps_in(TAKEN_AFTER_S)
            && self.crew.groups[task.index()].members.iter().any(is_there)
    }

    /// Goes on to the next place of the sweep if the present one was reached, is taken or cannot be reached.
    /// A robot with a full load ends its sweep.
    fn go_on_searching(&mut self, id: RobotId, scene: &Scene, is_held_up: bool) {
        let is_held_up = is_held_up || self.is_taken(id, scene);
        let agent = self.crew.agent(id);
        let (robot, traveller) = (&scene.beliefs.team[id.index()], scene.navigator.traveller(id));
        if robot.can_carry() && robot.free_capacity() == 0 {
            agent.sweep.clear();
        } else if agent.activity == Activity::Searching
            && (is_held_up || traveller.has_arrived(robot.position) || traveller.leads_nowhere())
            && traveller.goal().map(|goal| goal.point) == agent.sweep.last().copied()
        {
            agent.sweep.pop();
        }
        agent.activity = if agent.sweep.is_empty() { Activity::Standby } else { Activity::Searching };
    }

    /// Takes away the work of a group. The group then goes home, because nothing is left to do.
    pub fn withdraw(&mut self, task: TaskId) {
        for id in self.crew.groups[task.index()].members.clone() {
            self.release_claim(id);
            let agent = self.crew.agent(id);
            if agent.activity.is_in_field() {
                agent.sweep.clear();
                agent.activity = Activity::Standby;
            }
        }
    }
}

/// Whether a robot has no route to a rescuee, or has reached the end of its route out of reach of the
/// rescuee.
fn is_out_of_reach(id: RobotId, rescuee_at: Vector, scene: &Scene) -> bool {
    let traveller = scene.navigator.traveller(id);
    let robot = &scene.beliefs.team[id.index()];
    let reach = scene.model.mission.reach;
    let is_far = || (rescuee_at - robot.position).length() > reach;
    traveller.has_arrived(robot.position) && is_far() || traveller.leads_nowhere()
}
