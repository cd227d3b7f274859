//! What robots cause in the world: loading, delivering, resting, and what is lost with a robot that can no longer act.

use rne_core::Difficulty;

use super::{Activity, Mission, task_index};
use crate::event::{Event, EventLog, Place};
use crate::ids::{RescueeId, RobotId};
use crate::planning::Navigator;
use crate::world::{RescueeState, World};

/// For each task, the member that shares its resources, once it was looked for and until it gives one away.
type Sharing = [Option<Option<RobotId>>; 2];

impl Mission {
    /// Settles what robots do at the places where they have arrived.
    pub fn settle(&mut self, world: &mut World, navigator: &Navigator, step: u64, log: &mut EventLog) {
        let mut sharing = [None; 2];
        for id in 0..world.robots.len() {
            let robot = RobotId(id as u32);
            if !world.robots[id].is_able() {
                self.lose(robot, world);
                continue;
            }
            let arrived = || navigator.traveller(robot).has_arrived(world.robots[id].position);
            match self.agents[id].activity {
                Activity::Approaching(rescuee)
                    if self.can_reach(robot, rescuee, world)
                        && self.resource_holder(robot, world, &mut sharing).is_some() =>
                {
                    let done = step + self.steps(self.rules.loading_s);
                    self.agents[id].activity = Activity::Loading(rescuee, done);
                }
                Activity::Loading(rescuee, done) if step >= done => {
                    self.load(robot, rescuee, world, &mut sharing, log);
                }
                Activity::Returning if arrived() => {
                    deliver(robot, Place::Home, world, log);
                    self.agents[id].activity = Activity::Home;
                }
                Activity::ToRest if arrived() => {
                    deliver(robot, Place::Rest, world, log);
                    self.agents[id].activity = Activity::Resting(step + self.steps(self.rules.rest_s));
                    log.push(Event::RestStarted { robot });
                }
                Activity::Resting(done) if step >= done => {
                    world.robots[id].energy = 100.0;
                    world.robots[id].hp = 100.0;
                    self.agents[id].activity = Activity::Returning;
                    self.agents[id].has_rested = true;
                    log.push(Event::RestEnded { robot });
                }
                _ => {}
            }
        }
    }

    pub(super) fn steps(&self, seconds: f64) -> u64 {
        (seconds / self.dt).round() as u64
    }

    fn can_reach(&self, robot: RobotId, rescuee: RescueeId, world: &World) -> bool {
        let apart = world.rescuees[rescuee.index()].position - world.robots[robot.index()].position;
        apart.length() <= self.rules.reach_m as f32
    }

    /// Takes a rescuee on board, for one unit of capacity and one resource. When the resource is gone by now, the robot waits for
    /// another one.
    #[expect(clippy::too_many_arguments, reason = "those of `settle`, and what it remembers")]
    fn load(
        &mut self,
        robot: RobotId,
        rescuee: RescueeId,
        world: &mut World,
        sharing: &mut Sharing,
        log: &mut EventLog,
    ) {
        let can_reach = self.can_reach(robot, rescuee, world);
        let Some(resource_of) = self.resource_holder(robot, world, sharing).filter(|_| can_reach) else {
            self.agents[robot.index()].activity = Activity::Approaching(rescuee);
            return;
        };
        world.robots[resource_of.index()].resources -= 1;
        *sharing = [None; 2];
        world.robots[robot.index()].load.push(rescuee);
        let state = &mut world.rescuees[rescuee.index()];
        state.state = RescueeState::OnBoard(robot);
        state.claimed_by = None;
        self.agents[robot.index()].activity = Activity::Searching;
        log.push(Event::Loaded { robot, rescuee, resource_of });
    }

    /// The member whose resource a robot would use: itself, or the one that shares.
    fn resource_holder(&self, robot: RobotId, world: &World, sharing: &mut Sharing) -> Option<RobotId> {
        if world.robots[robot.index()].resources > 0 {
            return Some(robot);
        }
        let task = self.agents[robot.index()].task?;
        *sharing[task_index(task)].get_or_insert_with(|| self.sharing_member(task, world))
    }

    /// The member in the task area with the most resources left (the lowest id among equals).
    fn sharing_member(&self, task: Difficulty, world: &World) -> Option<RobotId> {
        let area = &self.areas[task_index(task)];
        let shares = |id: &RobotId| {
            let member = &world.robots[id.index()];
            member.resources > 0 && area.contains(member.position)
        };
        let resources = |id: &RobotId| world.robots[id.index()].resources;
        self.in_field(task, world).filter(shares).max_by_key(|id| (resources(id), u32::MAX - id.0))
    }

    /// Frees the rescuee that a robot had claimed when it could still act.
    fn lose(&mut self, robot: RobotId, world: &mut World) {
        self.release_claim(robot, world);
        let agent = &mut self.agents[robot.index()];
        if agent.activity.claim().is_some() {
            agent.activity = Activity::Standby;
        }
    }
}

/// Delivers everybody on board: they are rescued.
fn deliver(robot: RobotId, place: Place, world: &mut World, log: &mut EventLog) {
    for rescuee in std::mem::take(&mut world.robots[robot.index()].load) {
        world.rescuees[rescuee.index()].state = RescueeState::Rescued;
        log.push(Event::Delivered { robot, rescuee, place });
    }
}
