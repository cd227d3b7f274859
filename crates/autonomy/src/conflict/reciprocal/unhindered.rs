//! Robots that nobody hinders: they take their preferred velocity, whatever their share in the avoidance of
//! each other robot is.
//!
//! Two robots that would keep apart for the longest horizon, and by so much more as the robot still changes
//! its velocity, are on the free side of each other's half-plane. So most robots of a step need no
//! half-planes: the test is cheap and errs on the safe side only.

use std::sync::atomic::{AtomicBool, Ordering};

use parry2d::math::Vector;

use super::encounter::LONGEST_HORIZON_S;
use super::velocity::{LEAST_SHARE, MARGIN_M};

use crate::conflict::Mover;
use crate::conflict::predict::Neighbours;
use crate::executor::Executor;

/// Distance in which rounding is lost, in metres.
const ROUNDING_M: f32 = 0.001;

/// A robot on its way, for the test.
#[derive(Clone, Copy)]
struct Course {
    robot: usize,
    at: Vector,
    velocity: Vector,
    aerial: bool,
    radius: f32,
    /// Distance that the robot has to keep from others because it changes its velocity, in metres.
    swerve: f32,
    /// Distance from its place within which others matter at all, if they stand, in metres.
    reach: f32,
}

impl Course {
    fn of(robot: usize, me: &Mover) -> Self {
        let Mover { position: at, velocity, aerial, radius, .. } = *me;
        let change = (me.preferred.clamp_length_max(me.speed) - velocity).length();
        let swerve = change * LONGEST_HORIZON_S / LEAST_SHARE;
        let own = radius + 0.5 * MARGIN_M + ROUNDING_M;
        let reach = own + velocity.length() * LONGEST_HORIZON_S + swerve;
        Self { robot, at, velocity, aerial, radius, swerve, reach }
    }

    /// The square of the least distance between two robots within the horizon if both keep their velocities,
    /// in square metres.
    fn nearest_squared(&self, other: &Self) -> f32 {
        let (apart, closing) = (other.at - self.at, self.velocity - other.velocity);
        let (approach, speed_squared) = (apart.dot(closing), closing.length_squared());
        let when = if approach <= 0.0 {
            0.0
        } else if approach >= LONGEST_HORIZON_S * speed_squared {
            LONGEST_HORIZON_S
        } else {
            approach / speed_squared
        };
        (apart - closing * when).length_squared()
    }
}

/// For each robot, whether no other robot hinders it.
#[derive(Default)]
pub(in crate::conflict) struct Unhindered {
    courses: Vec<Course>,
    is_free: Vec<AtomicBool>,
}

impl Unhindered {
    /// Looks at all robots anew. The neighbours must be in order; robots farther apart than `range` metres do
    /// not matter.
    pub(super) fn find(&mut self, movers: &[Mover], neighbours: &Neighbours, range: f32, executor: Executor) {
        self.courses.clear();
        self.courses.extend(neighbours.by_x().iter().map(|(i, _)| Course::of(i, &movers[i])));
        self.is_free.clear();
        self.is_free.resize_with(movers.len(), || AtomicBool::new(true));
        let farthest = self.courses.iter().map(|course| course.reach).fold(0.0, f32::max);
        let meet_those_after = |(at, a): (usize, &Course)| {
            let widest = (a.reach + farthest).min(range);
            for b in &self.courses[at + 1..] {
                let apart = b.at - a.at;
                if apart.x > widest {
                    break;
                }
                let near = (a.reach + b.reach).min(range);
                if a.aerial != b.aerial || apart.length_squared() > near * near {
                    continue;
                }
                let (touch, nearest) = (a.radius + b.radius + MARGIN_M + ROUNDING_M, a.nearest_squared(b));
                for course in [a, b] {
                    let least = touch + course.swerve;
                    let is_clear = nearest > least * least; // false where a number is not finite
                    if !is_clear {
                        self.is_free[course.robot].store(false, Ordering::Relaxed);
                    }
                }
            }
        };
        let part = executor.part(self.courses.len());
        executor.run(self.courses.chunks(part).enumerate(), |(number, courses)| {
            let from = number * part;
            courses.iter().enumerate().for_each(|(at, course)| meet_those_after((from + at, course)));
        });
    }

    /// Whether no other robot hinders a robot.
    pub(super) fn is_free(&self, i: usize) -> bool {
        self.is_free[i].load(Ordering::Relaxed)
    }
}
