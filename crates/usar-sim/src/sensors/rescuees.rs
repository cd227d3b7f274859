//! The sensor of rescuees: those that wait within the observing range, and what is taken for one.

use parry2d::math::Vector;
use rand::RngExt;
use scenario::seed::{Purpose, normal, stream_at};
use teaming::TaskId;

use super::View;
use crate::belief::{Belief, KnownRescuee};
use crate::model::TaskModel;
use crate::report::{Report, Statement};
use crate::world::{Rescuee, RescueeState};

/// So long a robot sees a rescuee with the same error, in seconds.
const ERROR_HOLDS_S: f64 = 10.0;

/// A place that is seen so much better than it is known is told again.
const TOLD_AGAIN: f32 = 0.5;

/// Reports waiting rescuees that the belief has not heard of, or not where exactly they are.
pub(super) fn sense(view: &View, belief: &Belief, sent: &mut Vec<Report>) {
    let (observing, from) = (view.robot.observing_range() as f32, view.robot.position);
    let tasks = view.model.task_ids().zip(&view.model.tasks);
    let is_misplaced = |known: &KnownRescuee, at| view.model.has_misplaced && known.waits_at != Some(at);
    for (id, task) in tasks.filter(|(_, task)| is_near(task, observing, from)) {
        for rescuee in &view.world.rescuees[task.rescuees.clone()] {
            let at = rescuee.position;
            if rescuee.state != RescueeState::Waiting || (at - from).length_squared() > observing * observing
            {
                continue;
            }
            if view.model.has_sight_errors {
                sent.extend(seen_with_errors(view, rescuee, (at - from).length() / observing, belief));
            } else if belief.rescuees.get(rescuee.id.index()).is_none_or(|known| is_misplaced(known, at)) {
                sent.push(view.report(Statement::RescueeWaits { rescuee: rescuee.id, at }));
            }
        }
        sent.extend(false_alarm(view, id, observing));
    }
}

/// What a robot reports of a rescuee at this share of its range: nothing if it overlooks it, or knows of one
/// there.
fn seen_with_errors(view: &View, rescuee: &Rescuee, share: f32, belief: &Belief) -> Option<Report> {
    let (model, robot, sight) = (view.model, view.robot, view.robot.spec.sight);
    let pair = u64::from(robot.id.0) << 32 | u64::from(rescuee.id.0);
    let mut draws =
        stream_at(model.seed, Purpose::Sight, pair, view.step / model.steps_in(ERROR_HOLDS_S).max(1));
    let [x, y] = [(); 2].map(|()| normal(&mut draws, 0.0, sight.noise_m) as f32);
    let is_overlooked = draws.random::<f64>() < sight.miss;
    let (at, sd_m) = (rescuee.position + share * Vector::new(x, y), share * sight.noise_m as f32);
    let is_known = belief.rescuee_near(at, sd_m).is_some_and(|(_, known)| TOLD_AGAIN * known.sd_m <= sd_m);
    let is_exact = sd_m == 0.0;
    let number = if is_exact { rescuee.id } else { model.seen_as(rescuee.id, robot.id) };
    let is_known = is_known || is_exact && belief.rescuees.get(number.index()).is_some();
    (!is_overlooked && !is_known)
        .then(|| Report { sd_m, ..view.report(Statement::RescueeWaits { rescuee: number, at }) })
}

/// A rescuee that a robot sees in the area of a task and that does not exist.
fn false_alarm(view: &View, task: TaskId, observing: f32) -> Option<Report> {
    let sight = view.robot.spec.sight;
    let (per_min, sd_m) = (sight.false_alarms_per_min, sight.noise_m as f32);
    if per_min == 0.0 {
        return None;
    }
    let model = view.model;
    let mut draws = stream_at(model.seed, Purpose::FalseAlarm, u64::from(view.robot.id.0), view.step);
    let is_drawn = draws.random::<f64>() < per_min / 60.0 * model.control_period_s();
    let [x, y] = [(); 2].map(|()| observing * (2.0 * draws.random::<f32>() - 1.0));
    let (off, [min, max]) = (Vector::new(x, y), model.tasks[task.index()].bounds);
    let at = view.robot.position + off;
    let is_there = off.length() <= observing && at == at.clamp(min, max);
    let rescuee = model.phantom_of(task, view.robot.id);
    (is_drawn && is_there).then(|| Report { sd_m, ..view.report(Statement::RescueeWaits { rescuee, at }) })
}

/// Whether a task may have rescuees within `range` metres of a point.
fn is_near(task: &TaskModel, range: f32, of: Vector) -> bool {
    let [min, max] = task.bounds;
    !task.rescuees.is_empty() && (of - of.clamp(min, max)).length_squared() <= range * range
}
