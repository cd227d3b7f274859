//! The sensor of rescuees: those that wait within the observing range.

use parry2d::math::Vector;

use super::View;
use crate::belief::Belief;
use crate::model::TaskModel;
use crate::report::{Report, Statement};
use crate::world::RescueeState;

/// Reports waiting rescuees that the belief has not heard of.
pub(super) fn sense(view: &View, belief: &Belief, sent: &mut Vec<Report>) {
    let (observing, from) = (view.robot.observing_range() as f32, view.robot.position);
    for task in view.model.tasks.iter().filter(|task| is_near(task, observing, from)) {
        for rescuee in &view.world.rescuees[task.rescuees.clone()] {
            let at = rescuee.position;
            if belief.rescuees.get(rescuee.id.index()).is_none()
                && rescuee.state == RescueeState::Waiting
                && (at - from).length_squared() <= observing * observing
            {
                sent.push(view.report(Statement::RescueeWaits { rescuee: rescuee.id, at }));
            }
        }
    }
}

/// Whether a task may have rescuees within `range` metres of a point.
fn is_near(task: &TaskModel, range: f32, of: Vector) -> bool {
    let [min, max] = task.bounds;
    !task.rescuees.is_empty() && (of - of.clamp(min, max)).length_squared() <= range * range
}
