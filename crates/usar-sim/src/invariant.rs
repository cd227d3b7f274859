//! What must hold at every step of every trial: a listener that keeps its own account and compares the world with it.
//!
//! Independent of the mechanics: positions, levels and loads are read, never the code that moves them. One look costs a few hundred
//! nanoseconds for a dozen robots; `--check` switches it on.

use std::fmt;

use parry2d::math::{Pose, Vector};
use serde::Serialize;

use crate::event::Event;
use crate::ids::RobotId;
use crate::scenario::Scenario;
use crate::world::{RescueeState, Robot, World};

/// Deepest overlap that bodies may ever have, in metres.
pub const MAX_OVERLAP_M: f32 = 0.05;

/// Overlap that one contact in a thousand may exceed, in metres.
pub const RARE_OVERLAP_M: f32 = 0.01;

/// Beyond its top speed times the step, a robot may move this far in one step, in metres: the solver's correction of overlaps.
const STEP_SLACK_M: f32 = 1.0e-3;

/// In contact, a robot may be this much faster than its layer's top speed: one at top speed that another one pushes from the side at
/// top speed.
const PUSHED: f32 = std::f32::consts::SQRT_2;

/// A level that changes by less than this has not risen, in percent points.
const ROUNDING: f64 = 1.0e-9;

/// How near to its rest place a robot rests, in metres.
const AT_REST_M: f32 = 1.0;

/// Robots nearer than this touch something for the purpose of limits on acceleration, in metres.
const CONTACT_M: f32 = 0.02;

/// Debris farther than this from a robot is not measured, in metres.
const LOOK_M: f32 = 2.0;

/// Rounding of a distance in an arena, in metres: added to every way that is taken off a distance.
const ROUNDING_M: f32 = 1.0e-4;

/// A broken invariant: where, when and with which values.
#[derive(Debug, Clone, PartialEq)]
pub struct Violation {
    /// When, in seconds.
    pub time_s: f64,
    /// The robot, where there is one.
    pub robot: Option<RobotId>,
    /// What is wrong, with the values.
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

/// What one robot was like after the last step.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Before {
    position: Vector,
    velocity: Vector,
    levels: [f64; 2],
    resources: u32,
    /// Whether it touched something, or nearly.
    in_contact: bool,
}

/// What is known of the fixed debris round a robot.
#[derive(Debug, Clone)]
struct Look {
    /// Where the robot was when all of it was looked at.
    at: Vector,
    /// Numbers of the pieces that were nearer than [`LOOK_M`] then.
    near: Vec<usize>,
    /// None is nearer than this now, in metres.
    gap: f32,
}

impl Look {
    fn never() -> Self {
        Self { at: Vector::ZERO, near: Vec::new(), gap: f32::NEG_INFINITY }
    }
}

/// How deep bodies overlapped in a trial.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Overlaps {
    /// Robot-steps in contact with something.
    pub contacts: u64,
    /// Those deeper than [`RARE_OVERLAP_M`].
    pub rare: u64,
    /// The deepest, in metres.
    pub deepest_m: f32,
}

impl fmt::Display for Overlaps {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { contacts, rare, deepest_m } = self;
        let (deepest_mm, limit_mm) = (1000.0 * deepest_m.max(0.0), 1000.0 * RARE_OVERLAP_M);
        write!(
            f,
            "{contacts} robot-steps in contact, {rare} deeper than {limit_mm:.0} mm, deepest {deepest_mm:.1} mm"
        )
    }
}

/// The account of one trial.
pub struct Invariants {
    dt: f32,
    arena: Vector,
    /// Top speed of the fastest robot of each layer, ground and air, in metres per second: it may push others.
    fastest: [f32; 2],
    time_s: f64,
    before: Vec<Before>,
    /// Where each rescuee is by the events.
    rescuees: Vec<RescueeState>,
    on_board: usize,
    /// The changes of the world's rescuees that were compared with the account; none when the account has changed since.
    checked_changes: Option<u64>,
    /// Numbers of the movable debris.
    movable: Vec<usize>,
    /// Numbers of the fixed debris, and where each piece is to stay.
    fixed: Vec<(usize, Pose)>,
    /// For each robot, the last look at the fixed debris.
    looks: Vec<Look>,
    overlaps: Overlaps,
    by_x: Vec<usize>,
    overlap: Vec<f32>,
}

impl Invariants {
    /// The account before the next step, from the world as it is now.
    #[must_use]
    pub fn new(scenario: &Scenario, world: &World) -> Self {
        let fastest = |aerial: bool| {
            let layer = world.robots.iter().filter(|robot| robot.is_aerial() == aerial);
            layer.map(|robot| robot.spec.speed_mps as f32).fold(0.0, f32::max)
        };
        let before = |robot: &Robot| Before {
            position: robot.position,
            velocity: robot.velocity,
            levels: [robot.energy, robot.hp],
            resources: robot.resources,
            in_contact: false,
        };
        let x = |robot: &usize| world.robots[*robot].position.x;
        let mut by_x: Vec<usize> = (0..world.robots.len()).collect();
        by_x.sort_by(|a, b| x(a).total_cmp(&x(b)));
        let fixed = world.debris.iter().enumerate().filter(|(_, piece)| piece.is_fixed);
        let mut account = Self {
            dt: scenario.dt_s as f32,
            arena: Vector::new(scenario.arena_m[0] as f32, scenario.arena_m[1] as f32),
            fastest: [fastest(false), fastest(true)],
            time_s: 0.0,
            before: world.robots.iter().map(before).collect(),
            rescuees: world.rescuees.iter().map(|rescuee| rescuee.state).collect(),
            on_board: world.robots.iter().map(|robot| robot.load.len()).sum(),
            checked_changes: None,
            movable: (0..world.debris.len()).filter(|number| !world.debris[*number].is_fixed).collect(),
            fixed: fixed.map(|(number, piece)| (number, piece.outline.pose)).collect(),
            looks: vec![Look::never(); world.robots.len()],
            overlaps: Overlaps::default(),
            by_x,
            overlap: vec![f32::NEG_INFINITY; world.robots.len()],
        };
        account.measure_overlaps(world);
        for (before, overlap) in account.before.iter_mut().zip(&account.overlap) {
            before.in_contact = *overlap > -CONTACT_M;
        }
        account.overlaps = Overlaps::default();
        account
    }

    /// How deep bodies have overlapped so far.
    #[must_use]
    pub fn overlaps(&self) -> Overlaps {
        self.overlaps
    }

    /// Hears the events of a step, at the time of its end, and looks at the world as it is then.
    ///
    /// # Errors
    /// The first invariant that is broken.
    pub fn listen(&mut self, time_s: f64, events: &[Event], world: &World) -> Result<(), Violation> {
        if time_s.is_nan() || time_s < self.time_s {
            return Err(self.violation(None, format!("time went from {} s back to {time_s} s", self.time_s)));
        }
        self.time_s = time_s;
        for event in events {
            self.hear(event, world)?;
        }
        if world.physics.is_broken() {
            return Err(self.violation(None, "the physics set a body aside: its state is not finite".into()));
        }
        if let Some((number, _)) =
            self.fixed.iter().find(|(number, at)| world.debris[*number].outline.pose != *at)
        {
            return Err(self.violation(None, format!("debris {number} is fixed, but moved")));
        }
        self.measure_overlaps(world);
        for robot in &world.robots {
            self.check_robot(robot, events)?;
        }
        self.check_rescuees(world)
    }

    fn violation(&self, robot: Option<RobotId>, what: String) -> Violation {
        Violation { time_s: self.time_s, robot, what }
    }

    /// Keeps the account of rescuees and resources from the events alone.
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
            Event::RestEnded { robot } => {
                let robot = &world.robots[robot.index()];
                let apart = robot.rest.map(|place| (place - robot.position).length());
                if apart.iter().all(|metres| *metres > AT_REST_M + robot.radius()) {
                    let what = format!("rested {:.2} m from its rest place", apart[0].min(apart[1]));
                    return Err(self.violation(Some(robot.id), what));
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn check_robot(&mut self, robot: &Robot, events: &[Event]) -> Result<(), Violation> {
        let i = robot.id.index();
        let before = self.before[i];
        let in_contact = self.overlap[i] > -CONTACT_M;
        let now = Before {
            position: robot.position,
            velocity: robot.velocity,
            levels: [robot.energy, robot.hp],
            resources: robot.resources,
            in_contact,
        };
        if now == before && self.overlap[i] <= MAX_OVERLAP_M {
            return Ok(()); // it stands still, and was checked
        }
        let fail = |what: String| Err(self.violation(Some(robot.id), what));
        if !robot.position.is_finite() || !robot.velocity.is_finite() {
            return fail(format!("position {}, velocity {}", robot.position, robot.velocity));
        }
        for (name, now, then) in
            [("energy", robot.energy, before.levels[0]), ("HP", robot.hp, before.levels[1])]
        {
            if !(0.0..=100.0).contains(&now) {
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
        if let Err(what) = self.check_motion(robot, &before, in_contact) {
            return fail(what);
        }
        self.before[i] = now;
        Ok(())
    }

    /// Steps, speeds, accelerations and overlaps within their limits.
    fn check_motion(&self, robot: &Robot, before: &Before, in_contact: bool) -> Result<(), String> {
        let touches = in_contact || before.in_contact;
        let top = self.fastest[usize::from(robot.is_aerial())] * if touches { PUSHED } else { 1.0 };
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
        let greatest = robot.spec.acceleration_mps2 as f32;
        let limit = greatest * 1.01 + 1e-3;
        if change.length_squared() > limit * limit && !touches {
            let change = change.length();
            return Err(format!(
                "acceleration {change:.3} m/s^2 without contact, more than {greatest:.3} m/s^2"
            ));
        }
        let overlap = self.overlap[robot.id.index()];
        if overlap > MAX_OVERLAP_M {
            return Err(format!("overlaps another body by {overlap:.4} m, more than {MAX_OVERLAP_M} m"));
        }
        Ok(())
    }

    /// The deepest overlap of each robot with another of its layer, a wall or debris; negative is a gap, as far as it matters.
    fn measure_overlaps(&mut self, world: &World) {
        let robots = &world.robots;
        self.overlap.fill(f32::NEG_INFINITY);
        // By insertion: they are nearly sorted since the last step.
        for end in 1..self.by_x.len() {
            let mut at = end;
            while at > 0 && robots[self.by_x[at - 1]].position.x > robots[self.by_x[at]].position.x {
                self.by_x.swap(at - 1, at);
                at -= 1;
            }
        }
        for (at, i) in self.by_x.iter().enumerate() {
            let a = &robots[*i];
            for j in &self.by_x[at + 1..] {
                let b = &robots[*j];
                if b.position.x - a.position.x > 2.0 * a.radius().max(b.radius()) + CONTACT_M {
                    break;
                }
                if a.is_aerial() == b.is_aerial() {
                    let overlap = a.radius() + b.radius() - (a.position - b.position).length();
                    self.overlap[*i] = self.overlap[*i].max(overlap);
                    self.overlap[*j] = self.overlap[*j].max(overlap);
                }
            }
        }
        for robot in robots {
            let to_wall = robot.position.min(self.arena - robot.position).min_element();
            let with_debris = self.overlap_with_debris(robot, world);
            let overlap = &mut self.overlap[robot.id.index()];
            *overlap = overlap.max(robot.radius() - to_wall).max(with_debris);
            if *overlap > 0.0 {
                self.overlaps.contacts += 1;
                self.overlaps.rare += u64::from(*overlap > RARE_OVERLAP_M);
                self.overlaps.deepest_m = self.overlaps.deepest_m.max(*overlap);
            }
        }
    }

    /// The deepest overlap of a robot with debris; negative is a gap, as far as it matters. Fixed debris is looked at only when the robot
    /// has come far enough since the last look to touch any.
    fn overlap_with_debris(&mut self, robot: &Robot, world: &World) -> f32 {
        if robot.is_aerial() {
            return f32::NEG_INFINITY;
        }
        let gap = |number: &usize| {
            let piece = &world.debris[*number];
            let apart = (piece.outline.pose.translation - robot.position).length();
            let far = apart - piece.reach - robot.radius();
            if far < LOOK_M { piece.outline.signed_distance(robot.position) - robot.radius() } else { far }
        };
        let look = &mut self.looks[robot.id.index()];
        look.gap -= (robot.position - self.before[robot.id.index()].position).length() + ROUNDING_M;
        let is_far = look.gap > CONTACT_M; // false where a position is not finite
        if !is_far {
            let may_meet_others = (robot.position - look.at).length() > LOOK_M - CONTACT_M;
            if look.gap == f32::NEG_INFINITY || may_meet_others {
                look.at = robot.position;
                look.near.clear();
                look.near.extend(
                    self.fixed.iter().map(|(number, _)| *number).filter(|number| gap(number) < LOOK_M),
                );
            }
            let left = LOOK_M - (robot.position - look.at).length();
            look.gap = look.near.iter().map(gap).fold(left, f32::min);
        }
        let mut least = look.gap;
        for piece in self.movable.iter().map(|number| &world.debris[*number]) {
            let reach = piece.reach + robot.radius() + CONTACT_M;
            if (piece.outline.pose.translation - robot.position).length_squared() < reach * reach {
                least = least.min(piece.outline.signed_distance(robot.position) - robot.radius());
            }
        }
        -least
    }

    /// Every rescuee is where the account says, once, and nobody has more on board than there is room for.
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
