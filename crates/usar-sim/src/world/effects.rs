//! Effects: what comes of the intents of robots, as far as the world allows them.

use super::{RescueeState, World};
use crate::ids::{RescueeId, RobotId};
use crate::intent::{Intent, Outcome};
use crate::model::Model;

impl World {
    /// Carries out what a robot wants, or refuses it.
    pub(crate) fn carry_out(&mut self, robot: RobotId, intent: Intent, model: &Model) -> Outcome {
        let id = robot.index();
        match intent {
            Intent::BeginLoading { rescuee, .. } | Intent::Load { rescuee, .. }
                if !self.is_in_reach(robot, rescuee, model) =>
            {
                Outcome::NotThere(rescuee)
            }
            Intent::BeginLoading { rescuee, resource_of } | Intent::Load { rescuee, resource_of }
                if self.robots[resource_of.index()].resources == 0 =>
            {
                Outcome::NoResource(rescuee)
            }
            Intent::BeginLoading { rescuee, .. } | Intent::Load { rescuee, .. }
                if self.robots[id].free_capacity() == 0 =>
            {
                Outcome::NoRoom(rescuee)
            }
            Intent::BeginLoading { rescuee, .. } => Outcome::LoadingBegan(rescuee),
            Intent::Load { rescuee, resource_of } => {
                self.robots[resource_of.index()].resources -= 1;
                self.robots[id].load.push(rescuee);
                self.rescuees[rescuee.index()].state = RescueeState::OnBoard(robot);
                Outcome::Loaded { rescuee, resource_of }
            }
            Intent::Deliver { place } => {
                let rescuees = std::mem::take(&mut self.robots[id].load);
                for rescuee in &rescuees {
                    self.rescuees[rescuee.index()].state = RescueeState::Rescued;
                }
                Outcome::Delivered { place, rescuees }
            }
            Intent::Refill { levels } => {
                [self.robots[id].energy, self.robots[id].hp] = levels;
                Outcome::Refilled
            }
        }
    }

    /// The base restocks a robot.
    pub(crate) fn restock(&mut self, robot: RobotId) {
        let robot = &mut self.robots[robot.index()];
        robot.resources = robot.spec.resources;
    }

    /// Whether a rescuee waits within a robot's reach.
    fn is_in_reach(&self, robot: RobotId, rescuee: RescueeId, model: &Model) -> bool {
        let Some(rescuee) = self.rescuees.get(rescuee.index()) else { return false };
        let apart = rescuee.position - self.robots[robot.index()].position;
        rescuee.state == RescueeState::Waiting && apart.length() <= model.mission.reach
    }
}
