//! Errands: robots go from place to place; they take the place of the mission in scenarios that have them.

use parry2d::math::Vector;

use super::{Activity, Ending, Mission};
use crate::event::{Event, EventLog};
use crate::ids::RobotId;
use crate::planning::Navigator;
use crate::scenario::Scenario;
use crate::world::{Robot, World};

impl Mission {
    /// Hands out the errands of a scenario.
    pub(super) fn hand_out_errands(&mut self, scenario: &Scenario) {
        for errand in &scenario.errands {
            let agent = &mut self.agents[errand.robot as usize];
            let place = |[x, y]: &[f64; 2]| Vector::new(*x as f32, *y as f32);
            agent.sweep = errand.to.iter().rev().map(place).collect();
            agent.activity = Activity::OnErrand;
        }
    }

    /// Ticks off the places where robots have arrived, gives up on those to which there is no way, and says when all is over.
    pub(super) fn follow_errands(&mut self, world: &World, navigator: &Navigator, log: &mut EventLog) {
        for robot in &world.robots {
            if robot.is_able() && self.agents[robot.id.index()].activity == Activity::OnErrand {
                self.follow_errand(robot, navigator, log);
            }
        }
        let is_busy =
            |robot: &Robot| robot.is_able() && self.agents[robot.id.index()].activity == Activity::OnErrand;
        if !world.robots.iter().any(is_busy) {
            self.ending = Some(Ending::ErrandsOver);
            log.push(Event::ErrandsOver);
        }
    }

    fn follow_errand(&mut self, robot: &Robot, navigator: &Navigator, log: &mut EventLog) {
        let traveller = navigator.traveller(robot.id);
        let gives_up = self.gives_up(robot.id, navigator);
        let agent = &mut self.agents[robot.id.index()];
        let Some(place) = agent.sweep.last().copied() else { return };
        if traveller.goal().is_none_or(|goal| goal.point != place) {
            return; // not yet on its way
        }
        let apart = (place - robot.position).length();
        if traveller.has_arrived(robot.position) && apart <= robot.radius() {
            agent.muster = place;
            log.push(Event::ErrandDone { robot: robot.id });
        } else if gives_up || traveller.has_arrived(robot.position) {
            agent.muster = robot.position;
            log.push(Event::Unreachable { robot: robot.id, place: place.into() });
        } else {
            return;
        }
        agent.sweep.pop();
        if agent.sweep.is_empty() {
            agent.activity = Activity::Standby;
        }
    }

    /// Whether a robot has known no way to its goal for so long that it gives up on it.
    pub(super) fn gives_up(&self, robot: RobotId, navigator: &Navigator) -> bool {
        navigator.traveller(robot).lost_steps() >= self.steps(super::GIVE_UP_S)
    }
}
