//! The fixed properties of one rescuee.

use parry2d::math::Vector;
use scenario::Scenario;
use teaming::TaskId;

use super::places::{rescuee_blocks, rescuee_places};
use crate::ids::RescueeId;

/// The fixed properties of one rescuee.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RescueeModel {
    /// Identity.
    pub id: RescueeId,
    /// Its task.
    pub task: TaskId,
    /// Where it waits.
    pub position: Vector,
    /// Whether it is not there at the start: it appears with an event, or its task begins with one.
    pub is_later: bool,
}

impl RescueeModel {
    /// All rescuees of a scenario, by id.
    pub(super) fn compile_all(scenario: &Scenario) -> Vec<Self> {
        let rescuee = |(id, (task, position))| Self { id: RescueeId(id), task, position, is_later: false };
        let mut all: Vec<Self> = (0..).zip(rescuee_places(scenario)).map(rescuee).collect();
        if scenario.timeline.is_empty() {
            return all;
        }
        let begin_later: Vec<bool> = scenario.tasks.iter().map(|task| scenario.begins_later(task)).collect();
        for block in rescuee_blocks(scenario) {
            for rescuee in &mut all[block.ids] {
                rescuee.is_later = block.moment.is_some() || begin_later[rescuee.task.index()];
            }
        }
        all
    }
}
