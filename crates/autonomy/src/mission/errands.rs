//! Errands: robots go from place to place. In a scenario with errands, they replace the mission.

use super::{Activity, Crew, Progress, Scene};
use crate::belief::KnownRobot;
use crate::event::{CutOffCause, Event};
use crate::ids::RobotId;
use crate::model::Model;

impl Crew {
    /// Hands out the errands.
    pub(super) fn hand_out_errands(&mut self, model: &Model) {
        for errand in &model.errands {
            let agent = self.agent(errand.robot);
            agent.sweep = errand.to.iter().rev().copied().collect();
            agent.activity = Activity::OnErrand;
        }
    }

    /// Ticks off the places where robots have arrived, and gives up on places without a route and on those to
    /// which a robot comes no nearer, unless an event is to come that may open a way. Returns whether no able
    /// robot is on an errand any more.
    pub(super) fn follow_errands(&mut self, scene: &mut Scene) -> bool {
        for robot in 0..scene.beliefs.team.len() {
            if self.is_on_errand(&scene.beliefs.team[robot]) {
                self.follow_errand(RobotId(robot as u32), scene);
            }
        }
        !scene.beliefs.team.iter().any(|robot| self.is_on_errand(robot))
    }

    fn is_on_errand(&self, robot: &KnownRobot) -> bool {
        robot.is_able() && self.agents[robot.id.index()].activity == Activity::OnErrand
    }

    fn follow_errand(&mut self, id: RobotId, scene: &mut Scene) {
        self.note_way(id, scene);
        let robot = &scene.beliefs.team[id.index()];
        let (position, is_at_place) = (robot.position, scene.is_at_place(robot));
        let traveller = scene.navigator.traveller(id);
        let is_beside_place = traveller.has_arrived(position) && !is_at_place;
        if scene.awaits_opening {
            self.agents[id.index()].progress = Progress::default();
        }
        let Some(place) = self.agents[id.index()].sweep.last().copied() else { return };
        if traveller.goal().is_none_or(|goal| goal.point != place) {
            return; // not yet on its way
        }
        let cause = if is_beside_place { Some(CutOffCause::NoWay) } else { self.held_up_cause(id, scene) };
        if is_at_place {
            let agent = &mut self.agents[id.index()];
            (agent.muster, agent.is_cut_off) = (place, false);
            scene.log.push(Event::ErrandDone { robot: id });
        } else if let Some(cause) = cause.filter(|_| !scene.awaits_opening) {
            self.agents[id.index()].muster = position;
            self.give_up(id, place, cause, scene);
        } else {
            return;
        }
        let agent = &mut self.agents[id.index()];
        agent.sweep.pop();
        if agent.sweep.is_empty() {
            agent.activity = Activity::Standby;
        }
    }
}
