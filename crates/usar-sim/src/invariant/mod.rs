//! Invariants, which hold at every step of every trial. A listener keeps its own account and compares the
//! world with it.
//!
//! The check is independent of the mechanics: it reads positions, levels and loads, but uses none of the code
//! that changes them. Of the world's own accounts, it trusts only the count of changes of its rescuees. A
//! check takes a few hundred nanoseconds for a dozen robots; `--check` switches it on.

mod overlaps;

use std::fmt;

use parry2d::math::Vector;

use crate::event::Event;
use crate::ids::RobotId;
use crate::model::Model;
use crate::world::Robot;
use crate::world::{RescueeState, World};
use overlaps::Gauge;
pub use overlaps::{Overlaps, RARE_OVERLAP_M};

/// Deepest overlap that bodies may ever have, in metres.
pub(crate) const MAX_OVERLAP_M: f32 = 0.05;

/// Distance that a robot may move in one step beyond its top speed times the step, in metres: the solver's
/// correction of overlaps.
const STEP_SLACK_M: f32 = 1.0e-3;

/// Factor by which a robot in contact may exceed the top speed of its layer: a robot at top speed may be
/// pushed from the side by another one at top speed.
const PUSHED: f32 = std::f32::consts::SQRT_2;

/// Increase of a level that counts as rounding, in percent points.
const ROUNDING: f64 = 1.0e-9;

/// Distance within which a robot of any size has arrived at its place, in metres.
const ARRIVAL_M: f32 = 0.16;

/// Distance by which others may push a resting robot from its rest place, in metres.
const PUSHED_AT_REST_M: f32 = 1.0;

/// A broken invariant: the time, the robot and the values.
#[derive(Debug, Clone, PartialEq)]
pub struct Violation {
    /// The time, in seconds.
    pub time_s: f64,
    /// The robot, if one is concerned.
    pub robot: Option<RobotId>,
    /// The problem, with the values.
    pub what: String,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "invariant violated at {:.2} s: ", self.time_s)?;
        if let Some(robot) = self.robot {
            write!(f, "robot {robot}: ")?;
        }
        f.write_str(&self.what)
    }
}

/// The state of one robot after the last step.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Before {
    position: Vector,
    velocity: Vector,
    levels: [f64; 2],
    resources: u32,
    /// Whether it touched something or nearly did.
    in_contact: bool,
    /// Whether it may have touched something a step later.
    may_touch: bool,
}

impl Before {
    fn new(robot: &Robot, overlaps: &Gauge) -> Self {
        Self {
            position: robot.position,
            velocity: robot.velocity,
            levels: [robot.energy, robot.hp],
            resources: robot.resources,
            in_contact: overlaps.is_in_contact(robot.id),
            may_touch: overlaps.may_touch(robot.id),
        }
    }
}

/// The account of one trial.
pub struct Invariants {
    dt: f32,
    /// Top speed of the fastest robot of each layer, ground and air, in metres per second. It may push
    /// others.
    fastest: [f32; 2],
    /// The least energy and HP that a robot may have, in percent.
    least: [f64; 2],
    time_s: f64,
    before: Vec<Before>,
    /// The state of each rescuee by the events.
    rescuees: Vec<RescueeState>,
    on_board: usize,
    /// The number of changes of the world's rescuees at the last comparison; none if the account has changed
    /// since.
    checked_changes: Option<u64>,
    overlaps: Gauge,
    /// Whether no step was checked yet.
    is_first: bool,
}

impl Invariants {
    /// The account before the next step, from the world as it is now.
    pub fn new(model: &Model, world: &World) -> Self {
        let fastest = |aerial: bool| {
            let layer = world.robots.iter().filter(|robot| robot.is_aerial() == aerial);
            layer.map(|robot| robot.spec.top_speed).fold(0.0, f32::max)
        };
        let mut overlaps = Gauge::new(model, world);
        overlaps.measure(world);
        overlaps.forget();
        let before = |robot: &Robot| Before::new(robot, &overlaps);
        Self {
            dt: model.dt,
            fastest: [fastest(false), fastest(true)],
            least: [if model.mission.goes_on_empty { f64::NEG_INFINITY } else { 0.0 }, 0.0],
            time_s: 0.0,
            before: world.robots.iter().map(before).collect(),
            rescuees: world.rescuees.iter().map(|rescuee| rescuee.state).collect(),
            on_board: world.robots.iter().map(|robot| robot.load.len()).sum(),
            checked_changes: None,
            overlaps,
            is_first: true,
        }
    }

    /// How deep bodies have overlapped so far.
    pub fn overlaps(&self) -> Overlaps {
        self.overlaps.total()
    }

    /// Receives the events of a step, with the time of its end, and checks the world at that time.
    ///
    /// # Errors
    /// The first invariant that is broken.
    pub fn listen(&mut self, time_s: f64, events: &[Event], world: &World) -> Result<(), Violation> {
        if time_s.is_nan() || time_s < self.time_s {
            return Err(self.violation(None, format!("time went from {} s back to {time_s} s", self.time_s)));
        }
        self.time_s = time_s;
        for (i, event) in events.iter().enumerate() {
            let thing = switched(event);
            let is_undone = thing.is_some() && events[i + 1..].iter().any(|later| switched(later) == thing);
            if !is_undone {
                self.hear(event, world)?;
            }
        }
        if world.physics.is_broken() {
            return Err(self.violation(None, "the physics set a body aside: its state is not finite".into()));
        }
        if let Some(number) = self.overlaps.note_pushed(world) {
            return Err(self.violation(None, format!("debris {number} is fixed, but moved")));
        }
        self.overlaps.measure(world);
        for robot in &world.robots {
            self.check_robot(robot, events)?;
        }
        self.is_first = false;
        self.check_rescuees(world)
    }

    fn violation(&self, robot: Option<RobotId>, what: String) -> Violation {
        Violation { time_s: self.time_s, robot, what }
    }

    /// Updates the account from an event, and checks the event against the account and the world.
    fn hear(&mut self, event: &Event, world: &World) -> Result<(), Violation> {
        match event {
            Event::Restocked { robot, resources } => self.before[robot.index()].resources = *resources,
            Event::Loaded { robot, rescuee, resource_of } => {
                let was =
                    std::mem::replace(&mut self.rescuees[rescuee.index()], RescueeState::OnBoard(*robot));
                if was != RescueeState::Waiting {
                    return Err(
                        self.violation(Some(*robot), format!("loaded rescuee {rescuee}, which is {was:?}"))
                    );
                }
                let left = self.before[resource_of.index()].resources;
                let Some(left) = left.checked_sub(1) else {
                    return Err(
                        self.violation(Some(*resource_of), "gave a resource that it did not have".into())
                    );
                };
                self.before[resource_of.index()].resources = left;
                self.on_board += 1;
                self.checked_changes = None;
            }
            Event::Delivered { robot, rescuee, .. } => {
                let place = &mut self.rescuees[rescuee.index()];
                if *place != RescueeState::OnBoard(*robot) {
                    let what = format!("delivered rescuee {rescuee}, which it did not have on board");
                    return Err(self.violation(Some(*robot), what));
                }
                *place = RescueeState::Rescued;
                self.on_board -= 1;
                self.checked_changes = None;
            }
            Event::DebrisFell { debris } | Event::WayClosed { debris } | Event::WayOpened { debris } => {
                let is_there = world.debris[*debris as usize].is_there();
                if is_there == matches!(event, Event::WayOpened { .. }) {
                    return Err(
                        self.violation(None, format!("debris {debris} is not where its event put it"))
                    );
                }
                self.overlaps.note_put(*debris as usize, world);
            }
            Event::SourceAppeared { zone } | Event::SourceDied { zone }
                if world.is_on(*zone as usize) == matches!(event, Event::SourceDied { .. }) =>
            {
                return Err(self.violation(None, format!("radiation {zone} is not as its event left it")));
            }
            Event::Damaged { robot, energy, hp } => {
                let (now, then) = (&world.robots[robot.index()], self.before[robot.index()].levels);
                if now.energy > then[0] - energy + ROUNDING || now.hp > then[1] - hp + ROUNDING {
                    return Err(self.violation(Some(*robot), "kept the levels that it lost".to_owned()));
                }
            }
            Event::RescueesAppeared { first, count, .. } => {
                for id in *first..first + count {
                    let was = std::mem::replace(&mut self.rescuees[id as usize], RescueeState::Waiting);
                    if was != RescueeState::Absent {
                        return Err(self.violation(None, format!("rescuee {id} appeared, which was {was:?}")));
                    }
                }
                self.checked_changes = None;
            }
            Event::TaskEnded { task } => {
                let own = world.rescuees.iter().zip(&mut self.rescuees).filter(|(own, _)| own.task == *task);
                let waiting = own.filter(|(_, state)| **state == RescueeState::Waiting);
                waiting.for_each(|(_, state)| *state = RescueeState::Absent);
                self.checked_changes = None;
            }
            Event::RestStarted { robot } => {
                let robot = &world.robots[robot.index()];
                self.check_rest(robot, robot.radius().max(ARRIVAL_M))?;
            }
            Event::RestEnded { robot } => {
                let robot = &world.robots[robot.index()];
                self.check_rest(robot, PUSHED_AT_REST_M + robot.radius())?;
            }
            _ => {}
        }
        Ok(())
    }

    /// Checks that a resting robot is within this distance of a slot of its own at a rest place, in metres.
    fn check_rest(&self, robot: &Robot, within: f32) -> Result<(), Violation> {
        let apart = robot.rest.iter().map(|slot| (*slot - robot.position).length());
        let nearest = apart.fold(f32::INFINITY, f32::min);
        if nearest <= within {
            return Ok(());
        }
        Err(self.violation(Some(robot.id), format!("rested {nearest:.2} m from its rest place")))
    }

    fn check_robot(&mut self, robot: &Robot, events: &[Event]) -> Result<(), Violation> {
        let i = robot.id.index();
        let before = self.before[i];
        let now = Before::new(robot, &self.overlaps);
        if now == before && self.overlaps.of(robot.id) <= MAX_OVERLAP_M && !self.is_first {
            return Ok(()); // it stands still, and was checked
        }
        let fail = |what: String| Err(self.violation(Some(robot.id), what));
        if !robot.position.is_finite() || !robot.velocity.is_finite() {
            return fail(format!("position {}, velocity {}", robot.position, robot.velocity));
        }
        let [least_energy, least_hp] = self.least;
        for (name, now, then, least) in [
            ("energy", robot.energy, before.levels[0], least_energy),
            ("HP", robot.hp, before.levels[1], least_hp),
        ] {
            if !(least..=100.0).contains(&now) {
                return fail(format!("{name} {now} %"));
            }
            let has_rested = || events.contains(&Event::RestEnded { robot: robot.id });
            if now > then + ROUNDING && !has_rested() {
                return fail(format!("{name} rose from {then} % to {now} % outside a rest place"));
            }
        }
        if robot.resources != before.resources {
            return fail(format!("resources {}, should be {}", robot.resources, before.resources));
        }
        if let Err(what) = self.check_motion(robot, &before, &now) {
            return fail(what);
        }
        self.before[i] = now;
        Ok(())
    }

    /// Checks that steps, speeds, accelerations and overlaps are within their limits.
    fn check_motion(&self, robot: &Robot, before: &Before, now: &Before) -> Result<(), String> {
        // The engine predicts contacts, and pushes or brakes a robot in the step before it would touch
        // something.
        let touches = [now, before].iter().any(|state| state.in_contact || state.may_touch);
        let fastest = self.fastest[usize::from(robot.is_aerial())];
        // A robot that was pushed gets slower as its drive brakes it, not at once.
        let pushed = if touches { fastest * PUSHED } else { before.velocity.length().min(fastest * PUSHED) };
        let top = fastest.max(pushed);
        let step = robot.position - before.position;
        let longest = top * self.dt + STEP_SLACK_M;
        if step.length_squared() > longest * longest {
            let step = step.length();
            return Err(format!("moved {step:.4} m in one step, more than {longest:.4} m"));
        }
        let fastest = longest / self.dt;
        if robot.velocity.length_squared() > fastest * fastest {
            let speed = robot.velocity.length();
            return Err(format!("speed {speed:.4} m/s, more than {fastest:.4} m/s"));
        }
        let change = (robot.velocity - before.velocity) / self.dt;
        let greatest = robot.spec.acceleration;
        let limit = greatest * 1.01 + 1e-3;
        if change.length_squared() > limit * limit && !touches {
            let change = change.length();
            return Err(format!(
                "acceleration {change:.3} m/s^2 without contact, more than {greatest:.3} m/s^2"
            ));
        }
        let overlap = self.overlaps.of(robot.id);
        if overlap > MAX_OVERLAP_M {
            return Err(format!("overlaps another body by {overlap:.4} m, more than {MAX_OVERLAP_M} m"));
        }
        Ok(())
    }

    /// Checks that every rescuee is where the account says, exactly once, and that no robot exceeds its
    /// capacity.
    fn check_rescuees(&mut self, world: &World) -> Result<(), Violation> {
        if world.rescuees.len() != self.rescuees.len() {
            let what = format!("{} rescuees, should be {}", world.rescuees.len(), self.rescuees.len());
            return Err(self.violation(None, what));
        }
        if self.checked_changes != Some(world.rescuees.changes()) {
            for (rescuee, expected) in world.rescuees.iter().zip(&self.rescuees) {
                if rescuee.state != *expected {
                    let what =
                        format!("rescuee {} is {:?}, should be {expected:?}", rescuee.id, rescuee.state);
                    return Err(self.violation(None, what));
                }
            }
            self.checked_changes = Some(world.rescuees.changes());
        }
        let loads: usize = world.robots.iter().map(|robot| robot.load.len()).sum();
        for robot in world.robots.iter().filter(|robot| !robot.load.is_empty()) {
            let capacity = robot.spec.capacity as usize;
            if robot.load.len() > capacity {
                let what = format!("{} rescuees on board, room for {capacity}", robot.load.len());
                return Err(self.violation(Some(robot.id), what));
            }
            let is_not_its =
                |id: &&crate::ids::RescueeId| self.rescuees[id.index()] != RescueeState::OnBoard(robot.id);
            if let Some(stranger) = robot.load.iter().find(is_not_its) {
                return Err(
                    self.violation(Some(robot.id), format!("has rescuee {stranger} on board, unheard of"))
                );
            }
        }
        if loads != self.on_board {
            let what = format!("{loads} rescuees on board, should be {}", self.on_board);
            return Err(self.violation(None, what));
        }
        Ok(())
    }
}
/// The piece of debris, or the radiation zone, that an event puts, takes away or switches.
fn switched(event: &Event) -> Option<(&'static str, u32)> {
    match event {
        Event::DebrisFell { debris } | Event::WayClosed { debris } | Event::WayOpened { debris } => {
            Some(("debris", *debris))
        }
        Event::SourceAppeared { zone } | Event::SourceDied { zone } => Some(("zone", *zone)),
        _ => None,
    }
}
