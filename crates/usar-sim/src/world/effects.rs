//! Effects: what comes of the intents of robots, as far as the world allows them.

use super::{Rescuee, RescueeState, World};
use crate::ids::{RescueeId, RobotId};
use crate::intent::{Intent, Outcome, Sought};
use crate::model::Model;
use crate::report::gate_m;

impl World {
    /// Carries out what a robot wants, or refuses it.
    pub(crate) fn carry_out(&mut self, robot: RobotId, intent: Intent, model: &Model) -> Outcome {
        match intent {
            Intent::BeginLoading { sought, resource_of } => {
                self.may_load(robot, sought, resource_of, model).map_or_else(
                    |refusal| refusal,
                    |rescuee| {
                        self.loading.retain(|(other, _)| *other != robot);
                        self.loading.push((robot, rescuee));
                        Outcome::LoadingBegan(sought.rescuee)
                    },
                )
            }
            Intent::Load { sought, resource_of } => match self.may_load(robot, sought, resource_of, model) {
                Ok(rescuee) => self.load(robot, rescuee, sought.rescuee, resource_of),
                Err(refusal) => refusal,
            },
            Intent::Deliver { place } => {
                let rescuees = std::mem::take(&mut self.robots[robot.index()].load);
                for rescuee in &rescuees {
                    self.rescuees[rescuee.index()].state = RescueeState::Rescued;
                }
                Outcome::Delivered { place, rescuees }
            }
            Intent::Refill { levels } => {
                let robot = &mut self.robots[robot.index()];
                [robot.energy, robot.hp] = levels;
                Outcome::Refilled
            }
        }
    }

    /// The base restocks a robot.
    pub(crate) fn restock(&mut self, robot: RobotId) {
        let robot = &mut self.robots[robot.index()];
        robot.resources = robot.spec.resources;
    }

    /// Whether anybody is or was where a robot is after a rescuee.
    pub(crate) fn is_anybodys_place(&self, sought: Sought) -> bool {
        let is_there =
            |rescuee: &Rescuee| rescuee.state != RescueeState::Absent && is_within_gate(rescuee, sought);
        self.rescuees.iter().any(is_there)
    }

    /// The rescuee that a robot may take on board where it is after one.
    fn may_load(
        &self,
        robot: RobotId,
        sought: Sought,
        resource_of: RobotId,
        model: &Model,
    ) -> Result<RescueeId, Outcome> {
        let rescuee = self.found(robot, sought, model).ok_or(Outcome::NotThere(sought.rescuee))?;
        if self.loading.iter().any(|(other, loaded)| *other != robot && *loaded == rescuee) {
            Err(Outcome::Taken(sought.rescuee))
        } else if self.robots[resource_of.index()].resources == 0 {
            Err(Outcome::NoResource(sought.rescuee))
        } else if self.robots[robot.index()].free_capacity() == 0 {
            Err(Outcome::NoRoom(sought.rescuee))
        } else {
            Ok(rescuee)
        }
    }

    /// The rescuee that waits within a robot's reach and nearest to where the robot is after one, as near as
    /// may be the same.
    fn found(&self, robot: RobotId, sought: Sought, model: &Model) -> Option<RescueeId> {
        let from = self.robots[robot.index()].position;
        let is_in_reach = |rescuee: &&Rescuee| {
            rescuee.state == RescueeState::Waiting
                && (rescuee.position - from).length() <= model.mission.reach
                && is_within_gate(rescuee, sought)
        };
        let named = self.rescuees.get(sought.rescuee.index());
        if let Some(exact) = named.filter(|named| named.position == sought.at).filter(is_in_reach) {
            return Some(exact.id);
        }
        let off = |rescuee: &Rescuee| (rescuee.position - sought.at).length();
        let near = self.rescuees.iter().filter(is_in_reach);
        near.min_by(|a, b| off(a).total_cmp(&off(b))).map(|rescuee| rescuee.id)
    }

    fn load(
        &mut self,
        robot: RobotId,
        rescuee: RescueeId,
        sought: RescueeId,
        resource_of: RobotId,
    ) -> Outcome {
        self.robots[resource_of.index()].resources -= 1;
        self.robots[robot.index()].load.push(rescuee);
        self.rescuees[rescuee.index()].state = RescueeState::OnBoard(robot);
        self.loading.retain(|(other, _)| *other != robot);
        Outcome::Loaded { sought, rescuee, resource_of }
    }
}

/// Whether a rescuee may be the one that a robot is after, by its place.
fn is_within_gate(rescuee: &Rescuee, sought: Sought) -> bool {
    (rescuee.position - sought.at).length() <= gate_m([sought.sd_m, 0.0])
}
