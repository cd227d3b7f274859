//! Effects of robots on the world: loading, delivering, resting, and the claim of a robot that can no longer
//! act.

use rne_core::TaskId;
use rne_core::question::MAX_TASKS;

use super::round::{levels_after_rest, rest_time_s};
use super::{Activity, Mission, Scene};
use crate::event::{Event, EventLog, Place};
use crate::ids::{RescueeId, RobotId};
use crate::model::Model;
use crate::report::{Report, Speaker, Statement};
use crate::scenario::LoadAtRest;
use crate::world::{RescueeState, World};

/// For each task, the member that shares its resources: found on demand, and forgotten when a resource is
/// used.
type Sharing = [Option<Option<RobotId>>; MAX_TASKS];

impl Mission {
    /// Settles the activities of robots at the places where they have arrived.
    pub fn settle(&mut self, scene: &mut Scene) {
        let mut sharing = [None; MAX_TASKS];
        for id in 0..scene.world.robots.len() {
            let robot = RobotId(id as u32);
            if scene.world.robots[id].is_able() {
                self.settle_robot(robot, scene, &mut sharing);
            } else {
                self.lose(robot);
            }
        }
    }

    fn settle_robot(&mut self, robot: RobotId, scene: &mut Scene, sharing: &mut Sharing) {
        let (id, step, rules) = (robot.index(), scene.step, &scene.model.scenario.mission);
        let arrived = || scene.navigator.traveller(robot).has_arrived(scene.world.robots[id].position);
        let is_at_slot = || scene.is_at_place(&scene.world.robots[id]);
        match self.agents[id].activity {
            Activity::Approaching(rescuee)
                if can_reach(robot, rescuee, scene)
                    && self.resource_holder(robot, scene.model, scene.world, sharing).is_some() =>
            {
                let done = step + scene.model.steps(rules.loading_s);
                self.agents[id].activity = Activity::Loading(rescuee, done);
            }
            Activity::Loading(rescuee, done) if step >= done => self.load(robot, rescuee, scene, sharing),
            Activity::Returning if arrived() => {
                deliver(robot, Place::Home, scene.world, scene.log);
                self.agents[id].activity = Activity::Home;
            }
            Activity::ToRest if is_at_slot() => {
                if rules.load_at_rest == LoadAtRest::Delivered {
                    deliver(robot, Place::Rest, scene.world, scene.log);
                }
                let body = &scene.world.robots[id];
                let rest_s = rest_time_s(rules, [body.energy, body.hp]);
                self.agents[id].activity = Activity::Resting(step + scene.model.steps(rest_s));
                scene.log.push(Event::RestStarted { robot });
            }
            Activity::Resting(done) if !is_at_slot() => {
                self.agents[id].activity = Activity::Resting(done + 1);
            }
            Activity::Resting(done) if step >= done => {
                let body = &mut scene.world.robots[id];
                [body.energy, body.hp] = levels_after_rest(rules, [body.energy, body.hp]);
                self.agents[id].activity = Activity::Returning;
                self.agents[id].has_rested = true;
                scene.log.push(Event::RestEnded { robot });
            }
            _ => {}
        }
    }

    /// Takes a rescuee on board, for one unit of capacity and one resource. If no resource is left by now,
    /// the robot waits for another one.
    fn load(&mut self, robot: RobotId, rescuee: RescueeId, scene: &mut Scene, sharing: &mut Sharing) {
        let can_reach = can_reach(robot, rescuee, scene);
        let holder = self.resource_holder(robot, scene.model, scene.world, sharing);
        let Some(resource_of) = holder.filter(|_| can_reach) else {
            self.agents[robot.index()].activity = Activity::Approaching(rescuee);
            return;
        };
        scene.world.robots[resource_of.index()].resources -= 1;
        *sharing = [None; MAX_TASKS];
        scene.world.robots[robot.index()].load.push(rescuee);
        scene.world.rescuees[rescuee.index()].state = RescueeState::OnBoard(robot);
        self.claimed.set(rescuee, None);
        let says = Statement::RescueeIsGone { rescuee };
        scene.sent.push(Report { from: Speaker::Robot(robot), says, at_step: scene.step, sd_m: 0.0 });
        self.agents[robot.index()].activity = Activity::Searching;
        scene.log.push(Event::Loaded { robot, rescuee, resource_of });
    }

    /// The member whose resource a robot would use: the robot itself, or the member that shares.
    fn resource_holder(
        &self,
        robot: RobotId,
        model: &Model,
        world: &World,
        sharing: &mut Sharing,
    ) -> Option<RobotId> {
        if world.robots[robot.index()].resources > 0 {
            return Some(robot);
        }
        let task = self.agents[robot.index()].task?;
        *sharing[task.index()].get_or_insert_with(|| self.sharing_member(task, model, world))
    }

    /// The member in the task area with the most resources left (the lowest id among equals).
    fn sharing_member(&self, task: TaskId, model: &Model, world: &World) -> Option<RobotId> {
        let area = &model.tasks[task.index()].area;
        let shares = |id: &RobotId| {
            let member = &world.robots[id.index()];
            member.resources > 0 && area.contains(member.position)
        };
        let resources = |id: &RobotId| world.robots[id.index()].resources;
        self.in_field(task, world).filter(shares).max_by_key(|id| (resources(id), u32::MAX - id.0))
    }

    /// Frees the rescuee that a robot had claimed before it could no longer act.
    fn lose(&mut self, robot: RobotId) {
        self.release_claim(robot);
        let agent = &mut self.agents[robot.index()];
        if agent.activity.claim().is_some() {
            agent.activity = Activity::Standby;
        }
    }
}

/// Delivers all rescuees on board: they are rescued.
fn deliver(robot: RobotId, place: Place, world: &mut World, log: &mut EventLog) {
    for rescuee in std::mem::take(&mut world.robots[robot.index()].load) {
        world.rescuees[rescuee.index()].state = RescueeState::Rescued;
        log.push(Event::Delivered { robot, rescuee, place });
    }
}

/// Whether a rescuee is really there and within a robot's reach.
fn can_reach(robot: RobotId, rescuee: RescueeId, scene: &Scene) -> bool {
    let rescuee = &scene.world.rescuees[rescuee.index()];
    let apart = rescuee.position - scene.world.robots[robot.index()].position;
    rescuee.state == RescueeState::Waiting && apart.length() <= scene.model.scenario.mission.reach_m as f32
}
