//! Robots at the places where they wanted to be: what they want to do there, and what follows from what came
//! of it.

use std::ops::Range;

use scenario::LoadAtRest;
use teaming::question::MAX_TASKS;

use super::round::{levels_after_rest, rest_steps};
use super::{Activity, Mission, Scene};
use crate::event::{Event, Place};
use crate::ids::{RescueeId, RobotId};
use crate::intent::{Intent, Outcome, Sought};
use crate::report::{Report, Speaker, Statement};

/// For each task, the member that shares its resources: found on demand, and forgotten when a resource is
/// used.
pub type Sharing = [Option<Option<RobotId>>; MAX_TASKS];

impl Mission {
    /// The first robot in `robots` that wants to do something where it is, and what it wants.
    pub fn settle(
        &mut self,
        robots: &mut Range<u32>,
        scene: &mut Scene,
        sharing: &mut Sharing,
    ) -> Option<(RobotId, Intent)> {
        let mut wants = |robot| Some((robot, self.settle_robot(robot, scene, sharing)?));
        robots.map(RobotId).find_map(&mut wants)
    }

    fn settle_robot(&mut self, robot: RobotId, scene: &mut Scene, sharing: &mut Sharing) -> Option<Intent> {
        if !scene.beliefs.team[robot.index()].is_able() {
            self.lose(robot);
            return None;
        }
        match self.crew.agents[robot.index()].activity {
            Activity::Approaching(rescuee) => {
                let (sought, resource_of) = self.resource_for(robot, rescuee, scene, sharing)?;
                Some(Intent::BeginLoading { sought, resource_of })
            }
            Activity::Loading(rescuee, done) if scene.step >= done => {
                let holder = self.resource_for(robot, rescuee, scene, sharing);
                if holder.is_none() {
                    self.crew.agent(robot).activity = Activity::Approaching(rescuee);
                }
                holder.map(|(sought, resource_of)| Intent::Load { sought, resource_of })
            }
            Activity::Returning if has_arrived(robot, scene) => Some(Intent::Deliver { place: Place::Home }),
            Activity::ToRest if is_at_slot(robot, scene) => {
                if scene.model.mission.load_at_rest == LoadAtRest::Delivered {
                    return Some(Intent::Deliver { place: Place::Rest });
                }
                self.begin_rest(robot, scene);
                None
            }
            Activity::Resting(done) => self.rest(robot, done, scene),
            _ => None,
        }
    }

    /// Takes into account what came of the intent of a robot.
    pub fn note(&mut self, robot: RobotId, outcome: Outcome, scene: &mut Scene, sharing: &mut Sharing) {
        match outcome {
            Outcome::LoadingBegan(rescuee) => {
                let done = scene.step + scene.model.mission.loading_steps;
                self.crew.agent(robot).activity = Activity::Loading(rescuee, done);
            }
            Outcome::NoResource(rescuee) => self.crew.agent(robot).activity = Activity::Approaching(rescuee),
            Outcome::NoRoom(rescuee) => {
                self.claims.free(rescuee, robot);
                self.crew.agent(robot).activity = Activity::Searching;
            }
            Outcome::NotThere(rescuee) => {
                if scene.model.has_misplaced {
                    self.claims.give_up(rescuee, robot);
                }
                self.go_on_without(rescuee, robot, scene);
            }
            Outcome::Taken(rescuee) => {
                self.claims.give_up(rescuee, robot);
                self.release_claim(robot);
                self.crew.agent(robot).activity = Activity::Searching;
            }
            Outcome::Loaded { sought, rescuee, resource_of } => {
                *sharing = [None; MAX_TASKS];
                self.go_on_without(sought, robot, scene);
                scene.log.push(Event::Loaded { robot, rescuee, resource_of });
            }
            Outcome::Delivered { place, rescuees } => {
                for rescuee in rescuees {
                    let task = scene.model.rescuees[rescuee.index()].task;
                    scene.beliefs.ledger.note_delivery(robot, task);
                    scene.log.push(Event::Delivered { robot, rescuee, place });
                }
                match place {
                    Place::Home => self.crew.agent(robot).activity = Activity::Home,
                    Place::Rest => self.begin_rest(robot, scene),
                }
            }
            Outcome::Refilled => {
                let agent = self.crew.agent(robot);
                (agent.activity, agent.has_rested) = (Activity::Returning, true);
                scene.log.push(Event::RestEnded { robot });
            }
        }
    }

    /// A rescuee no longer waits: its robot says so, and goes on searching.
    fn go_on_without(&mut self, rescuee: RescueeId, robot: RobotId, scene: &mut Scene) {
        self.claims.free(rescuee, robot);
        let says = Statement::RescueeIsGone { rescuee };
        scene.sent.push(Report { from: Speaker::Robot(robot), says, at_step: scene.step, sd_m: 0.0 });
        self.crew.agent(robot).activity = Activity::Searching;
    }

    fn begin_rest(&mut self, robot: RobotId, scene: &mut Scene) {
        let state = &scene.beliefs.team[robot.index()];
        let steps = rest_steps(&scene.model.mission, [state.energy, state.hp]);
        self.crew.agent(robot).activity = Activity::Resting(scene.step + steps);
        scene.log.push(Event::RestStarted { robot });
    }

    /// Goes on with a rest until its end. Time off the rest place does not count.
    fn rest(&mut self, robot: RobotId, done: u64, scene: &Scene) -> Option<Intent> {
        if !is_at_slot(robot, scene) {
            self.crew.agent(robot).activity = Activity::Resting(done + scene.model.control_steps);
            return None;
        }
        let state = &scene.beliefs.team[robot.index()];
        let levels = || levels_after_rest(&scene.model.mission, [state.energy, state.hp]);
        (scene.step >= done).then(|| Intent::Refill { levels: levels() })
    }

    /// A rescuee within the reach of a robot, and the member whose resource it would use: the robot itself,
    /// or the member that shares. None if the rescuee is not within reach, or no resource is left.
    fn resource_for(
        &self,
        robot: RobotId,
        rescuee: RescueeId,
        scene: &Scene,
        sharing: &mut Sharing,
    ) -> Option<(Sought, RobotId)> {
        let task = self.crew.agents[robot.index()].task?;
        let (sought, state) = (scene.sought(robot, task, rescuee)?, &scene.beliefs.team[robot.index()]);
        if (sought.at - state.position).length() > scene.model.mission.reach {
            return None;
        }
        if state.resources > 0 {
            return Some((sought, robot));
        }
        let sharing = sharing[task.index()].get_or_insert_with(|| self.crew.sharing_member(task, scene));
        sharing.map(|member| (sought, member))
    }

    /// Frees the rescuee that a robot had claimed before it could no longer act.
    fn lose(&mut self, robot: RobotId) {
        self.release_claim(robot);
        let agent = &mut self.crew.agents[robot.index()];
        if agent.activity.claim().is_some() {
            agent.activity = Activity::Standby;
        }
    }
}

fn has_arrived(robot: RobotId, scene: &Scene) -> bool {
    scene.navigator.traveller(robot).has_arrived(scene.beliefs.team[robot.index()].position)
}

fn is_at_slot(robot: RobotId, scene: &Scene) -> bool {
    scene.is_at_place(&scene.beliefs.team[robot.index()])
}
