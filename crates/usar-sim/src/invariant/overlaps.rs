//! How deep bodies overlap, measured from their shapes and poses alone.

use std::fmt;

use parry2d::math::{Pose, Vector};
use serde::{Deserialize, Serialize};

use crate::ids::RobotId;
use crate::model::Model;
use crate::world::Robot;
use crate::world::{Debris, World};

/// Overlap that one contact in a thousand may exceed, in metres.
pub const RARE_OVERLAP_M: f32 = 0.01;

/// Gap below which a robot counts as touching something, for the limits on its motion, in metres.
const CONTACT_M: f32 = 0.02;

/// Debris farther than this from a robot is not measured, in metres: more than any robot moves in one step.
const LOOK_M: f32 = 2.0;

/// Rounding error of a distance in an arena, in metres: subtracted along with every distance that a robot
/// moved.
const ROUNDING_M: f32 = 1.0e-4;

/// How deep bodies overlapped in a trial.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Overlaps {
    /// Robot-steps in contact with something.
    pub contacts: u64,
    /// Contacts deeper than [`RARE_OVERLAP_M`].
    pub rare: u64,
    /// The deepest overlap, in metres.
    pub deepest_m: f32,
}

impl fmt::Display for Overlaps {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { contacts, rare, deepest_m } = self;
        let (deepest_mm, limit_mm) = (1000.0 * deepest_m.max(0.0), 1000.0 * RARE_OVERLAP_M);
        write!(
            f,
            "{contacts} robot-steps in contact, {rare} deeper than {limit_mm:.0} mm, deepest {deepest_mm:.1} \
             mm"
        )
    }
}

/// The unmoved debris near a robot, as of its last measurement.
#[derive(Debug, Clone)]
struct Look {
    /// Position of the robot when all unmoved debris was searched.
    at: Vector,
    /// Last position of the robot.
    last: Vector,
    /// Numbers of the pieces that were nearer than [`LOOK_M`] at the search.
    near: Vec<usize>,
    /// Lower bound for the present gap to any of this debris, in metres.
    gap: f32,
}

impl Look {
    fn never() -> Self {
        Self { at: Vector::ZERO, last: Vector::ZERO, near: Vec::new(), gap: f32::NEG_INFINITY }
    }
}

/// Measures overlaps from step to step.
pub(super) struct Gauge {
    arena: Vector,
    dt: f32,
    /// Radius of the largest robot, in metres.
    largest: f32,
    /// For each robot, the distance that it may move in the next step, in metres.
    reach: Vec<f32>,
    /// The greatest of these distances, in metres.
    longest_reach: f32,
    /// For each robot, whether it may touch something within a step. The engine brakes it before it does.
    may_touch: Vec<bool>,
    /// Numbers of the debris that has not moved yet, and the pose of each piece.
    still: Vec<(usize, Pose)>,
    /// Numbers of the debris that was pushed, and of the debris that events place or remove.
    pushed: Vec<usize>,
    /// Numbers of the pieces that events place or remove, and their poses after their last events.
    put: Vec<(usize, Pose)>,
    /// For each robot, its last measurement of the debris that has not moved.
    looks: Vec<Look>,
    /// Numbers of the robots in order of x.
    by_x: Vec<usize>,
    /// For each robot, the deepest overlap in this step, in metres; negative is a gap.
    overlap: Vec<f32>,
    total: Overlaps,
}

/// The pieces that no event places or removes.
fn still(world: &World) -> impl Iterator<Item = (usize, &Debris)> {
    world.debris.iter().enumerate().filter(|(_, piece)| !piece.is_gate())
}

impl Gauge {
    /// A gauge without any measurement.
    pub(super) fn new(model: &Model, world: &World) -> Self {
        let x = |robot: &usize| world.robots[*robot].position.x;
        let mut by_x: Vec<usize> = (0..world.robots.len()).collect();
        by_x.sort_by(|a, b| x(a).total_cmp(&x(b)));
        Self {
            arena: model.arena,
            dt: model.dt,
            largest: world.robots.iter().map(|robot| robot.radius()).fold(0.0, f32::max),
            reach: vec![0.0; world.robots.len()],
            longest_reach: 0.0,
            may_touch: vec![false; world.robots.len()],
            still: still(world).map(|(number, piece)| (number, piece.pose)).collect(),
            pushed: model.gates.clone(),
            put: model.gates.iter().map(|number| (*number, world.debris[*number].pose)).collect(),
            looks: vec![Look::never(); world.robots.len()],
            by_x,
            overlap: vec![f32::NEG_INFINITY; world.robots.len()],
            total: Overlaps::default(),
        }
    }

    /// Resets the totals.
    pub(super) fn forget(&mut self) {
        self.total = Overlaps::default();
    }

    /// The totals so far.
    pub(super) fn total(&self) -> Overlaps {
        self.total
    }

    /// The deepest overlap of a robot in this step, in metres. A negative value is a gap; large gaps are not
    /// exact.
    pub(super) fn of(&self, robot: RobotId) -> f32 {
        self.overlap[robot.index()]
    }

    /// Whether a robot touches something or nearly does.
    pub(super) fn is_in_contact(&self, robot: RobotId) -> bool {
        self.of(robot) > -CONTACT_M
    }

    /// Whether a robot touches something, or may within a step at the speeds of the last one.
    pub(super) fn may_touch(&self, robot: RobotId) -> bool {
        self.may_touch[robot.index()]
    }

    /// Notes the distances that robots may move in a step: at their speed, plus the greatest gain of their
    /// drives.
    fn note_reach(&mut self, robots: &[Robot]) {
        for (reach, robot) in self.reach.iter_mut().zip(robots) {
            let gain = robot.spec.acceleration * self.dt;
            *reach = CONTACT_M + (robot.velocity.length() + gain) * self.dt;
        }
        self.longest_reach = self.reach.iter().copied().fold(0.0, f32::max);
    }

    /// Notes a piece that an event has put to a place, or away.
    pub(super) fn note_put(&mut self, debris: usize, world: &World) {
        let own = self.put.iter_mut().filter(|(number, _)| *number == debris);
        own.for_each(|(number, pose)| *pose = world.debris[*number].pose);
    }

    /// Notes the pieces that were pushed for the first time. Returns the number of a fixed piece that has
    /// moved, if there is one.
    pub(super) fn note_pushed(&mut self, world: &World) -> Option<usize> {
        if let Some((number, _)) = self.put.iter().find(|(number, at)| world.debris[*number].pose != *at) {
            return Some(*number);
        }
        while let Some(at) = self.still.iter().position(|(number, at)| world.debris[*number].pose != *at) {
            let (number, _) = self.still[at];
            if world.debris[number].is_fixed() {
                return Some(number);
            }
            self.still.swap_remove(at);
            self.pushed.push(number);
        }
        None
    }

    /// Measures the deepest overlap of each robot with another robot of its layer, a wall or debris. A
    /// negative value is a gap; large gaps are not exact.
    pub(super) fn measure(&mut self, world: &World) {
        let robots = &world.robots;
        self.overlap.fill(f32::NEG_INFINITY);
        self.may_touch.fill(false);
        self.note_reach(robots);
        // Insertion sort: the order of the last step is nearly right.
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
                let farthest = a.radius() + self.largest + self.reach[*i] + self.longest_reach;
                if b.position.x - a.position.x > farthest {
                    break;
                }
                if a.is_aerial() == b.is_aerial() {
                    let overlap = a.radius() + b.radius() - (a.position - b.position).length();
                    self.overlap[*i] = self.overlap[*i].max(overlap);
                    self.overlap[*j] = self.overlap[*j].max(overlap);
                    let is_near = -overlap < self.reach[*i] + self.reach[*j];
                    self.may_touch[*i] |= is_near;
                    self.may_touch[*j] |= is_near;
                }
            }
        }
        for robot in robots {
            let to_wall = robot.position.min(self.arena - robot.position).min_element();
            let with_debris = self.with_debris(robot, world);
            let fixed = with_debris.max(robot.radius() - to_wall);
            let overlap = &mut self.overlap[robot.id.index()];
            *overlap = overlap.max(fixed);
            self.may_touch[robot.id.index()] |= -fixed < self.reach[robot.id.index()];
            if *overlap > 0.0 {
                self.total.contacts += 1;
                self.total.rare += u64::from(*overlap > RARE_OVERLAP_M);
                self.total.deepest_m = self.total.deepest_m.max(*overlap);
            }
        }
    }

    /// The deepest overlap of a robot with debris. A negative value is a gap; large gaps are not exact.
    /// Debris that has not moved is measured only if the robot has moved far enough since the last
    /// measurement to touch any.
    fn with_debris(&mut self, robot: &Robot, world: &World) -> f32 {
        if robot.is_aerial() {
            return f32::NEG_INFINITY;
        }
        let gap = |number: &usize| {
            let piece = &world.debris[*number];
            let apart = (piece.pose.translation - robot.position).length();
            let far = apart - piece.reach - robot.radius();
            if far < LOOK_M { piece.signed_distance(robot.position) - robot.radius() } else { far }
        };
        let look = &mut self.looks[robot.id.index()];
        look.gap -= (robot.position - look.last).length() + ROUNDING_M;
        look.last = robot.position;
        let reach = self.reach[robot.id.index()];
        let is_far = look.gap > reach; // false where a position is not finite
        if !is_far {
            let may_meet_others = (robot.position - look.at).length() > LOOK_M - reach;
            if look.gap == f32::NEG_INFINITY || may_meet_others {
                look.at = robot.position;
                look.near.clear();
                look.near.extend(
                    self.still.iter().map(|(number, _)| *number).filter(|number| gap(number) < LOOK_M),
                );
            }
            let left = LOOK_M - (robot.position - look.at).length();
            look.gap = look.near.iter().map(gap).fold(left, f32::min);
        }
        let mut least = look.gap;
        for piece in self.pushed.iter().map(|number| &world.debris[*number]) {
            let far = piece.reach + robot.radius() + reach + self.longest_reach;
            if (piece.pose.translation - robot.position).length_squared() < far * far {
                let gap = piece.signed_distance(robot.position) - robot.radius();
                self.may_touch[robot.id.index()] |= gap < reach + self.longest_reach;
                least = least.min(gap);
            }
        }
        -least
    }
}
