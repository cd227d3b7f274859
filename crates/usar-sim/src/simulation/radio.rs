//! What group-mates tell one another by radio of the things in the field.

use scenario::BeliefSharing;

use super::State;
use crate::model::Model;
use crate::report::{Report, Speaker, Statement};
use crate::telemetry::in_turn;

impl State {
    /// Robots tell their group-mates what they noticed, and liars what they make up.
    pub(super) fn say(&mut self, noticed: &[Report], model: &Model) {
        if model.mission.belief_sharing != BeliefSharing::ByRadio {
            return;
        }
        let (mission, mut scene) = self.scene(model);
        let crew = &mission.crew;
        mission.with_telemetry(&mut scene, |telemetry, now, log| {
            for robot in in_turn(now.team.iter(), now) {
                let own = noticed.iter().filter(|report| report.from == Speaker::Robot(robot.id));
                own.for_each(|report| telemetry.say_to_mates(report, crew.mates_of(robot.id), now, log));
            }
        });
    }

    /// Liars tell their group-mates of rescuees that do not exist.
    pub(super) fn make_up_rescuees(&mut self, model: &Model) {
        if !model.has_phantoms {
            return;
        }
        let (mission, mut scene) = self.scene(model);
        let crew = &mission.crew;
        mission.with_telemetry(&mut scene, |telemetry, now, log| {
            for (robot, agent) in now.team.iter().zip(&crew.agents) {
                let Some(task) = agent.task.filter(|_| agent.activity.is_in_field()) else { continue };
                let Some(at) = telemetry.phantom(robot, model.tasks[task.index()].bounds, now) else {
                    continue;
                };
                let says = Statement::RescueeWaits { rescuee: model.phantom_of(task, robot.id), at };
                let report = Report { from: Speaker::Robot(robot.id), says, at_step: now.step, sd_m: 0.0 };
                telemetry.say_to_mates(&report, crew.mates_of(robot.id), now, log);
            }
        });
    }

    /// Group-mates hear what has arrived by now.
    pub(super) fn hear_mates(&mut self, model: &Model) {
        let (mission, mut scene) = self.scene(model);
        mission.hear_mates(&mut scene);
    }
}
