//! The stage of a step in which robots do what they came for: they load, deliver and rest.

use teaming::question::MAX_TASKS;

use super::State;
use crate::model::Model;
use crate::report::Report;

impl State {
    /// One robot after the other wants something; the world lets it happen or not; the robot notices. Robots
    /// notice their own state before, and again when something has happened.
    pub(super) fn rescue(&mut self, model: &Model, heard: &mut Vec<Report>) {
        self.feel(model, heard);
        let mut sharing = [None; MAX_TASKS];
        let mut robots = 0..self.world.robots.len() as u32;
        loop {
            let (mission, mut scene) = self.scene(model);
            let Some((robot, intent)) = mission.settle(&mut robots, &mut scene, &mut sharing) else { break };
            let outcome = self.world.carry_out(robot, intent, model);
            self.feel(model, heard);
            let (mission, mut scene) = self.scene(model);
            mission.note(robot, outcome, &mut scene, &mut sharing);
        }
        self.hear(model, heard);
    }
}
