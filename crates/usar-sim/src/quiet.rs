//! Quiet steps: those in which no robot can touch anything. Robots then move as the engine would move them,
//! and the engine rests.
//!
//! Each robot has a budget: the way that it may go before it can touch something. It is the distance to the
//! nearest wall or piece of debris, or half the distance to the nearest robot, whichever is less. A robot
//! that has used it up is measured again. So a step costs little for robots far from everything.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

/// Bodies with at least this gap, in metres, beyond the way that they go in a step, do not touch.
const GAP_M: f32 = 0.005;

/// Things farther than this from a robot are not measured, in metres.
const REACH_M: f32 = 4.0;

/// Ways are taken for longer by this share, and by the next constant in metres: what comes of rounding.
const ROUNDING: f32 = 1.01;
const ROUNDING_M: f32 = 1.0e-5;

/// Parts of a step in which the engine moves bodies.
const PARTS: u8 = 4;

/// A robot as a disc that moves.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub(crate) struct Disc {
    /// Centre, in metres.
    pub at: Vector,
    /// Metres per second.
    pub velocity: Vector,
    /// What does not change.
    #[serde(skip)]
    pub fixed: Fixed,
}

/// What does not change about a disc. Snapshots leave it out.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Fixed {
    /// Metres.
    pub radius: f32,
    /// Whether it flies over debris and ground robots.
    pub is_aerial: bool,
    /// Its mass and the inverse, as the engine has them.
    pub masses: [f32; 2],
}

/// The robots, and how far each may go.
#[derive(Serialize, Deserialize)]
pub(crate) struct Quiet {
    /// Length of a step, in seconds.
    #[serde(skip)]
    pub dt: f32,
    /// Width and height of the arena, in metres.
    #[serde(skip)]
    pub arena: Vector,
    /// The robots, by id.
    pub discs: Vec<Disc>,
    /// The budget of each robot, in metres. Budgets only save time: those that are missing are measured.
    #[serde(skip)]
    budgets: Vec<f32>,
}

impl Quiet {
    /// Discs in an arena, in steps of `dt` seconds.
    pub(crate) fn new(dt: f32, arena: Vector, discs: Vec<Disc>) -> Self {
        Self { dt, arena, discs, budgets: Vec::new() }
    }

    /// Has everything measured again: something other than a robot has moved.
    pub(crate) fn forget(&mut self) {
        self.budgets.clear();
    }

    /// Whether nobody can touch anything in this step. `to_debris` is the distance from a point to the
    /// nearest piece of debris, at most the given reach, in metres.
    pub(crate) fn is_quiet(&mut self, to_debris: impl Fn(Vector, f32) -> f32) -> bool {
        self.budgets.resize(self.discs.len(), 0.0);
        (0..self.discs.len()).all(|i| self.budgets[i] > self.least(i) || self.is_free(i, &to_debris))
    }

    /// The least budget with which a robot cannot touch anything in this step, in metres.
    fn least(&self, i: usize) -> f32 {
        GAP_M + self.discs[i].velocity.length() * self.dt * ROUNDING
    }

    /// Measures how far a robot may go. Returns whether it can touch nothing in this step.
    fn is_free(&mut self, i: usize, to_debris: impl Fn(Vector, f32) -> f32) -> bool {
        let me = self.discs[i];
        let inside = me.at.min(self.arena - me.at).min_element();
        let debris = if me.fixed.is_aerial { REACH_M } else { to_debris(me.at, REACH_M) };
        let fixed = inside.min(debris).min(REACH_M) - me.fixed.radius;
        let is_clear = fixed > self.least(i); // false where a number is not finite: the engine tells
        if !is_clear {
            return false;
        }
        let mut budget = fixed;
        for (j, other) in self.discs.iter().enumerate() {
            if j == i || other.fixed.is_aerial != me.fixed.is_aerial {
                continue;
            }
            let touch = me.fixed.radius + other.fixed.radius;
            let (apart, far) = ((other.at - me.at).length_squared(), touch + 2.0 * REACH_M);
            if apart >= far * far {
                continue;
            }
            let gap = apart.sqrt() - touch;
            let is_clear = gap > GAP_M + (me.velocity - other.velocity).length() * self.dt * ROUNDING;
            if !is_clear {
                return false;
            }
            budget = budget.min(0.5 * gap);
            self.budgets[j] = self.budgets[j].min(0.5 * gap);
        }
        self.budgets[i] = budget;
        true
    }

    /// Moves the robots in a quiet step.
    pub(crate) fn coast(&mut self) {
        let part = self.dt / f32::from(PARTS);
        for (disc, budget) in self.discs.iter_mut().zip(&mut self.budgets) {
            if disc.velocity == Vector::ZERO {
                continue;
            }
            let change = disc.velocity * part;
            (0..PARTS).for_each(|_| disc.at += change);
            *budget -= disc.velocity.length() * self.dt * ROUNDING + ROUNDING_M;
        }
    }

    /// Takes the motion of a robot from the engine.
    pub(crate) fn moved(&mut self, i: usize, at: Vector, velocity: Vector) {
        let disc = &mut self.discs[i];
        let way = (at - disc.at).length() * ROUNDING + ROUNDING_M;
        (disc.at, disc.velocity) = (at, velocity);
        self.budgets.get_mut(i).into_iter().for_each(|budget| *budget -= way);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc(x: f32, velocity: f32) -> Disc {
        let fixed = Fixed { radius: 0.4, ..Fixed::default() };
        Disc { at: Vector::new(x, 10.0), velocity: Vector::new(velocity, 0.0), fixed }
    }

    fn quiet(discs: &[Disc]) -> Quiet {
        Quiet::new(0.02, Vector::splat(20.0), discs.to_vec())
    }

    #[test]
    fn a_step_is_quiet_until_somebody_can_touch_something() {
        let nothing = |_: Vector, reach: f32| reach;
        assert!(quiet(&[disc(5.0, 1.0), disc(6.0, -1.0)]).is_quiet(nothing));
        assert!(!quiet(&[disc(5.0, 1.0), disc(5.84, -1.0)]).is_quiet(nothing), "they meet in this step");
        assert!(quiet(&[disc(5.0, 1.0), disc(5.81, 1.0)]).is_quiet(nothing), "in step, side by side");
        assert!(!quiet(&[disc(0.41, -1.0)]).is_quiet(nothing), "at the border");
        assert!(!quiet(&[disc(5.0, 1.0)]).is_quiet(|_, _| 0.42), "at debris");
        let mut flying = disc(5.84, -1.0);
        flying.fixed.is_aerial = true;
        assert!(quiet(&[disc(5.0, 1.0), flying]).is_quiet(nothing), "above");
        assert!(!quiet(&[disc(5.0, f32::NAN)]).is_quiet(nothing), "not a number");
    }

    #[test]
    fn no_touch_is_missed_on_the_way() {
        let (mut moving, wall) = (quiet(&[disc(5.0, 2.0), disc(12.0, -0.5)]), 16.0);
        let to_wall = |at: Vector, reach: f32| (wall - at.x).min(reach);
        let steps = (0..1000).position(|_| {
            let is_quiet = moving.is_quiet(to_wall);
            moving.coast();
            !is_quiet
        });
        let gap = (12.0 - 5.0 - 0.8) - 2.5 * 0.02 * steps.unwrap() as f32;
        assert!((0.0..0.06).contains(&gap), "{gap} m apart");
        let measured = std::cell::Cell::new(0);
        let mut alone = quiet(&[disc(5.0, 0.1)]);
        for _ in 0..100 {
            assert!(alone.is_quiet(|at, reach| {
                measured.set(measured.get() + 1);
                to_wall(at, reach)
            }));
            alone.coast();
        }
        assert_eq!(measured.get(), 1, "far from everything, nothing is measured");
    }
}
