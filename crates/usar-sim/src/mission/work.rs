//! Work in the field: claims on rescuees, and the search for more.

use parry2d::math::Vector;
use rne_core::TaskId;

use super::{Activity, Mission, Scene};
use crate::belief::SENSING_PERIOD_STEPS;
use crate::event::Event;
use crate::ids::{RescueeId, RobotId};
use crate::model::Model;
use crate::navigation::Navigator;
use crate::world::{RescueeState, Robot, World};

/// What a group can still claim in a step.
#[derive(Default)]
pub(super) struct Supply {
    is_known: bool,
    /// Resources in the field that no claim needs; negative where there are more claims than resources.
    spare: i64,
    rescuees: Vec<RescueeId>,
}

impl Supply {
    /// It is to be found anew.
    pub(super) fn forget(&mut self) {
        self.is_known = false;
    }

    fn note_claim(&mut self, claimed: RescueeId) {
        self.spare -= 1;
        self.rescuees.retain(|rescuee| *rescuee != claimed);
    }

    fn nearest(&self, here: Vector, world: &World) -> Option<RescueeId> {
        let distance = |id: &RescueeId| (world.rescuees[id.index()].position - here).length_squared();
        let nearest = self.rescuees.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b)));
        nearest.copied().filter(|_| self.spare > 0)
    }
}

impl Mission {
    /// Rescuees that a group knows of and that nobody has claimed.
    pub(super) fn available<'w>(
        &'w self,
        task: TaskId,
        model: &Model,
        world: &'w World,
    ) -> impl Iterator<Item = RescueeId> + use<'w> {
        let known = &self.knowledge[task.index()].rescuees;
        let is_available = move |i: &usize| {
            let rescuee = &world.rescuees[*i];
            known[*i]
                && rescuee.state == RescueeState::Waiting
                && rescuee.claimed_by.is_none()
                && !self.unreachable[*i]
        };
        model.tasks[task.index()].rescuees.clone().filter(is_available).map(|i| RescueeId(i as u32))
    }

    /// A robot's next activity, where it is free to choose.
    pub(super) fn choose_activity(&mut self, id: RobotId, scene: &mut Scene) {
        let robot = &scene.world.robots[id.index()];
        let activity = self.agents[id.index()].activity;
        let Some(task) = self.agents[id.index()].task.filter(|_| robot.is_able()) else { return };
        match activity {
            Activity::Approaching(rescuee) if is_out_of_reach(id, rescuee, scene) => {
                self.unreachable[rescuee.index()] = true;
                let place = scene.world.rescuees[rescuee.index()].position.into();
                scene.log.push(Event::Unreachable { robot: id, place });
                self.release_claim(id, scene.world);
                self.supplies[task.index()].forget();
                self.agent(id).activity = Activity::Searching;
            }
            Activity::Searching | Activity::Standby if self.groups[task.index()].at_work => {
                let looks_for_work = (scene.step + u64::from(id.0)).is_multiple_of(SENSING_PERIOD_STEPS)
                    && robot.free_capacity() > 0;
                if looks_for_work && let Some(rescuee) = self.nearest_available(task, id, scene) {
                    self.supplies[task.index()].note_claim(rescuee);
                    scene.world.rescuees[rescuee.index()].claimed_by = Some(id);
                    self.agent(id).activity = Activity::Approaching(rescuee);
                    return;
                }
                self.go_on_searching(id, &scene.world.robots[id.index()], scene.navigator);
            }
            _ => {}
        }
    }

    fn go_on_searching(&mut self, id: RobotId, robot: &Robot, navigator: &Navigator) {
        let agent = &mut self.agents[id.index()];
        let traveller = navigator.traveller(id);
        if robot.can_carry() && robot.free_capacity() == 0 {
            agent.sweep.clear();
        } else if agent.activity == Activity::Searching
            && (traveller.has_arrived(robot.position) || traveller.leads_nowhere())
            && traveller.goal().map(|goal| goal.point) == agent.sweep.last().copied()
        {
            agent.sweep.pop();
        }
        agent.activity = if agent.sweep.is_empty() { Activity::Standby } else { Activity::Searching };
    }

    /// The nearest rescuee that a robot may claim: there must be a resource for it in the field that no other claim needs.
    fn nearest_available(&mut self, task: TaskId, id: RobotId, scene: &Scene) -> Option<RescueeId> {
        if !self.supplies[task.index()].is_known {
            self.take_stock(task, scene.model, scene.world);
        }
        self.supplies[task.index()].nearest(scene.world.robots[id.index()].position, scene.world)
    }

    fn take_stock(&mut self, task: TaskId, model: &Model, world: &World) {
        let resources = |id: RobotId| i64::from(world.robots[id.index()].resources);
        let claims = |id: RobotId| i64::from(self.agents[id.index()].activity.claim().is_some());
        let spare = self.in_field(task, world).map(|id| resources(id) - claims(id)).sum();
        let mut rescuees = std::mem::take(&mut self.supplies[task.index()].rescuees);
        rescuees.clear();
        if spare > 0 {
            rescuees.extend(self.available(task, model, world));
        }
        self.supplies[task.index()] = Supply { is_known: true, spare, rescuees };
    }
}

/// Whether a robot's route ends, or there is none, before the rescuee is within reach.
fn is_out_of_reach(id: RobotId, rescuee: RescueeId, scene: &Scene) -> bool {
    let traveller = scene.navigator.traveller(id);
    let robot = &scene.world.robots[id.index()];
    let apart = (scene.world.rescuees[rescuee.index()].position - robot.position).length();
    let reach = scene.model.scenario.mission.reach_m as f32;
    let at_end = traveller.has_arrived(robot.position) && apart > reach;
    at_end || traveller.leads_nowhere()
}
