//! What the base knows of the tasks, as a dispatcher does: which are open, and how many rescuees wait there.

use teaming::TaskId;

use crate::model::Model;
use crate::report::{Report, Speaker, Statement};
use crate::world::{Rescuee, RescueeState, World};

/// The base's report of a task.
pub(crate) fn report(world: &World, model: &Model, task: TaskId, step: u64) -> Report {
    let open = world.closed_tasks.get(task.index()) != Some(&true);
    let waits = |rescuee: &&Rescuee| rescuee.state == RescueeState::Waiting;
    let rescuees = world.rescuees[model.tasks[task.index()].rescuees.clone()].iter();
    let waiting = rescuees.filter(waits).count() as u32;
    Report { from: Speaker::Base, says: Statement::TaskIs { task, open, waiting }, at_step: step, sd_m: 0.0 }
}
