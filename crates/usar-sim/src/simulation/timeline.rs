//! The timeline of a trial: each event of the scenario happens at the beginning of its step.

use parry2d::query::distance;
use scenario::shapes::Outline;
use teaming::TaskId;

use super::State;
use super::charge::{bearable, last_event, spend};
use crate::event::Event;
use crate::ids::RobotId;
use crate::model::{Action, DebrisModel, Model};
use crate::report::{Report, Speaker, Statement};
use crate::sensors::base;
use crate::world::{RescueeState, Robot, World};

/// Debris falls or closes only if no robot may come nearer than this within a few steps, in metres.
const FREE_M: f32 = 0.1;

/// Number of steps of a robot at its present speed for which the place must stay free.
const FREE_STEPS: f32 = 3.0;

impl State {
    /// Carries out the events that are due. A piece of debris waits until its place is free, or until its way
    /// is to be open.
    pub(super) fn happen(&mut self, model: &Model) {
        for (number, due) in model.timeline.iter().enumerate() {
            if due.step > self.step {
                break;
            }
            if !self.timeline.done[number] {
                if let Action::Open(debris) = due.action {
                    self.call_off(debris, number, model);
                }
                self.timeline.done[number] = self.act_out(&due.action, model);
            }
        }
    }

    /// Calls off what waits to put a piece of debris in its place, of the events before this one.
    fn call_off(&mut self, debris: usize, before: usize, model: &Model) {
        for (due, done) in model.timeline[..before].iter().zip(&mut self.timeline.done) {
            let puts = due.action == Action::Fall(debris) || due.action == Action::Close(debris);
            if puts && !std::mem::replace(done, true) {
                self.log.push(Event::CalledOff { debris: debris as u32 });
            }
        }
    }

    /// Carries out an action. Returns false if it has to wait.
    fn act_out(&mut self, action: &Action, model: &Model) -> bool {
        match action {
            Action::Fall(debris) | Action::Close(debris) => {
                if self.world.debris[*debris].is_there() {
                    return true;
                }
                if !is_free(&self.world, *debris, model) {
                    return false;
                }
                self.world.put_debris(*debris, Some(model.debris[*debris].first_pose), self.step);
                let debris = *debris as u32;
                let falls = matches!(action, Action::Fall(_));
                self.log.push(if falls { Event::DebrisFell { debris } } else { Event::WayClosed { debris } });
            }
            Action::Open(debris) => {
                if self.world.debris[*debris].is_there() {
                    self.world.put_debris(*debris, None, self.step);
                    self.log.push(Event::WayOpened { debris: *debris as u32 });
                }
            }
            Action::Appear(zone) => {
                if self.world.switch_zone(*zone, true, self.step) {
                    self.log.push(Event::SourceAppeared { zone: *zone as u32 });
                }
            }
            Action::Die(zone) => {
                if self.world.switch_zone(*zone, false, self.step) {
                    self.log.push(Event::SourceDied { zone: *zone as u32 });
                }
            }
            Action::Fail(robot) => {
                let hp = self.world.robots[robot.index()].hp;
                self.lose(*robot, [0.0, hp], model);
            }
            Action::Lose(robot, losses) => self.lose(*robot, *losses, model),
            Action::Slow(robot, factor) => {
                self.faults.of(*robot).speed = *factor;
                self.log.push(Event::Slowed { robot: *robot, factor: *factor });
            }
            Action::Fade(robot, factor) => {
                self.faults.of(*robot).energy = *factor;
                self.log.push(Event::Faded { robot: *robot, factor: *factor });
            }
            Action::Lie(robot, lie) => {
                self.telemetry.iter_mut().for_each(|telemetry| telemetry.begin_lie(*robot, *lie));
                self.log.push(Event::BeganToLie { robot: *robot });
            }
            Action::BeHonest(robot) => {
                self.telemetry.iter_mut().for_each(|telemetry| telemetry.be_honest(*robot));
                self.log.push(Event::BecameHonest { robot: *robot });
            }
            Action::Mute(robot) => {
                self.telemetry.iter_mut().for_each(|telemetry| telemetry.mute(*robot));
                self.log.push(Event::Muted { robot: *robot });
            }
            Action::Rescuees(task, ids) => {
                let rescuees = &mut self.world.rescuees[ids.clone()];
                rescuees.iter_mut().for_each(|rescuee| rescuee.state = RescueeState::Waiting);
                let (first, count) = (ids.start as u32, ids.len() as u32);
                self.log.push(Event::RescueesAppeared { task: *task, first, count });
                self.announce(*task, model);
            }
            Action::Begin(task) => self.begin_task(*task, model),
            Action::End(task) if self.world.closed_tasks[task.index()] => {}
            Action::End(task) => {
                self.world.closed_tasks[task.index()] = true;
                self.log.push(Event::TaskEnded { task: *task });
                self.withdraw(*task, model);
                self.announce(*task, model);
            }
        }
        true
    }

    /// The base tells all robots how a task is.
    fn announce(&mut self, task: TaskId, model: &Model) {
        self.sent.push(base::report(&self.world, model, task, self.step));
    }

    /// Removes the rescuees of a task that still wait. The base tells all robots that they are gone.
    fn withdraw(&mut self, task: TaskId, model: &Model) {
        for rescuee in &mut self.world.rescuees[model.tasks[task.index()].rescuees.clone()] {
            if rescuee.state == RescueeState::Waiting {
                rescuee.state = RescueeState::Absent;
                let says = Statement::RescueeIsGone { rescuee: rescuee.id };
                self.sent.push(Report { from: Speaker::Base, says, at_step: self.step, sd_m: 0.0 });
            }
        }
        self.mission.withdraw(task);
    }

    /// Opens a task. Its own rescuees appear when it begins for the first time. Rescuees of later events
    /// appear with those events.
    fn begin_task(&mut self, task: TaskId, model: &Model) {
        if !std::mem::replace(&mut self.world.closed_tasks[task.index()], false) {
            return;
        }
        self.announce(task, model);
        self.log.push(Event::TaskBegan { task });
        let begins = |action: &Action| *action == Action::Begin(task) || *action == Action::End(task);
        let mut done = model.timeline.iter().zip(&self.timeline.done);
        let is_first = !done.any(|(due, is_done)| *is_done && begins(&due.action));
        let own = model.tasks[task.index()].appear_at_begin.as_ref();
        if let Some(ids) = own.filter(|_| is_first) {
            self.act_out(&Action::Rescuees(task, ids.clone()), model);
        }
    }

    /// Takes energy and HP from a robot that can still act. A robot whose energy or HP reaches 0 stays where
    /// it is.
    fn lose(&mut self, id: RobotId, levels: [f64; 2], model: &Model) {
        let robot = &mut self.world.robots[id.index()];
        if !robot.is_able() {
            return;
        }
        let [energy, hp] = bearable(robot, levels, &model.mission);
        self.log.push(Event::Damaged { robot: id, energy, hp });
        spend(robot, [energy, hp], model.costs.unit, &mut self.listeners.metrics);
        self.log.extend(last_event(robot, &model.mission));
        self.notice_selves();
    }
}

/// Whether the place of a piece is free of ground robots and movable debris, and stays free of robots for a
/// few steps.
fn is_free(world: &World, debris: usize, model: &Model) -> bool {
    let DebrisModel { shape, first_pose, .. } = &*model.debris[debris];
    let outline = Outline { shape: shape.clone(), pose: *first_pose };
    let dt = model.dt;
    let is_clear = |robot: &Robot| {
        let way = robot.velocity.length() * FREE_STEPS * dt;
        robot.is_aerial() || outline.signed_distance(robot.position) > robot.radius() + FREE_M + way
    };
    let touches = |other: &Outline| {
        let apart = distance(&outline.pose, &*outline.shape, &other.pose, &*other.shape);
        apart.is_ok_and(|apart| apart.distance <= FREE_M)
    };
    world.robots.iter().all(is_clear)
        && !world.debris.iter().filter(|piece| !piece.is_fixed()).any(|piece| touches(&piece.outline()))
}
