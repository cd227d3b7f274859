//! The stage of a step in which robots do what they came for: they load, deliver and rest.

use teaming::question::MAX_TASKS;

use super::State;
use crate::ids::RobotId;
use crate::intent::{Intent, Outcome};
use crate::mission::Activity;
use crate::model::Model;
use crate::report::Report;

impl State {
    /// One robot after the other wants something; the world lets it happen or not; the robot notices. Robots
    /// notice their own state before, and again when something has happened.
    pub(super) fn rescue(&mut self, model: &Model, heard: &mut Vec<Report>) {
        self.feel(model, heard);
        let agents = &self.mission.crew.agents;
        let is_loading = |robot: RobotId| matches!(agents[robot.index()].activity, Activity::Loading(..));
        self.world.loading.retain(|(robot, _)| is_loading(*robot));
        let mut sharing = [None; MAX_TASKS];
        let mut robots = 0..self.world.robots.len() as u32;
        loop {
            let (mission, mut scene) = self.scene(model);
            let Some((robot, intent)) = mission.settle(&mut robots, &mut scene, &mut sharing) else { break };
            let outcome = self.world.carry_out(robot, intent, model);
            self.note_in_vain(intent, &outcome);
            self.feel(model, heard);
            let (mission, mut scene) = self.scene(model);
            mission.note(robot, outcome, &mut scene, &mut sharing);
        }
        self.hear(model, heard);
    }

    /// Counts the robots that are after somebody who is not there to be loaded.
    fn note_in_vain(&mut self, intent: Intent, outcome: &Outcome) {
        let Intent::BeginLoading { sought, .. } = intent else { return };
        let is_taken = matches!(outcome, Outcome::Taken(_));
        if !is_taken && !matches!(outcome, Outcome::NotThere(_)) {
            return;
        }
        let was_anybody = is_taken || self.world.is_anybodys_place(sought);
        let finds = &mut self.listeners.metrics.finds;
        finds.doubles += u32::from(was_anybody);
        finds.ghosts_visited += u32::from(!was_anybody);
    }
}
