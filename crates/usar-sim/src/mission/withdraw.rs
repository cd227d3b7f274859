//! The end of a task: its waiting rescuees disappear, and its group goes home.

use rne_core::TaskId;

use super::{Activity, Mission};
use crate::model::Model;
use crate::world::{RescueeState, World};

impl Mission {
    /// Removes the rescuees of a task that still wait, and the work of its group. The group then goes home,
    /// because nothing is left to do.
    pub(crate) fn withdraw(&mut self, task: TaskId, model: &Model, world: &mut World) {
        for rescuee in &mut world.rescuees[model.tasks[task.index()].rescuees.clone()] {
            if rescuee.state == RescueeState::Waiting {
                (rescuee.state, rescuee.claimed_by) = (RescueeState::Absent, None);
            }
        }
        for id in self.groups[task.index()].members.clone() {
            let agent = self.agent(id);
            if agent.activity.is_in_field() {
                agent.sweep.clear();
                agent.activity = Activity::Standby;
            }
        }
    }
}
