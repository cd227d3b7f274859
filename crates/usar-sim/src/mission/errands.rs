//! Errands: robots go from place to place. In a scenario with errands, they replace the mission.

use super::{Activity, Crew, Scene};
use crate::event::Event;
use crate::ids::RobotId;
use crate::model::Model;
use crate::robot::Robot;

impl Crew {
    /// Hands out the errands.
    pub(super) fn hand_out_errands(&mut self, model: &Model) {
        for errand in &model.errands {
            let agent = self.agent(errand.robot);
            agent.sweep = errand.to.iter().rev().copied().collect();
            agent.activity = Activity::OnErrand;
        }
    }

    /// Ticks off the places where robots have arrived, and gives up on places without a route. Returns
    /// whether no able robot is on an errand any more.
    pub(super) fn follow_errands(&mut self, scene: &mut Scene) -> bool {
        for robot in 0..scene.beliefs.team.len() {
            if self.is_on_errand(&scene.beliefs.team[robot]) {
                self.follow_errand(RobotId(robot as u32), scene);
            }
        }
        !scene.beliefs.team.iter().any(|robot| self.is_on_errand(robot))
    }

    fn is_on_errand(&self, robot: &Robot) -> bool {
        robot.is_able() && self.agents[robot.id.index()].activity == Activity::OnErrand
    }

    fn follow_errand(&mut self, id: RobotId, scene: &mut Scene) {
        let traveller = scene.navigator.traveller(id);
        let robot = &scene.beliefs.team[id.index()];
        let (gives_up, is_at_place) = (scene.gives_up(id), scene.is_at_place(robot));
        let agent = &mut self.agents[id.index()];
        let Some(place) = agent.sweep.last().copied() else { return };
        if traveller.goal().is_none_or(|goal| goal.point != place) {
            return; // not yet on its way
        }
        if is_at_place {
            agent.muster = place;
            scene.log.push(Event::ErrandDone { robot: id });
        } else if gives_up || traveller.has_arrived(robot.position) {
            agent.muster = robot.position;
            scene.log.push(Event::Unreachable { robot: id, place: place.into() });
        } else {
            return;
        }
        agent.sweep.pop();
        if agent.sweep.is_empty() {
            agent.activity = Activity::Standby;
        }
    }
}
