//! Robots that can touch nothing in a step. They move as the engine would move them, without it: in a quiet
//! step all of them, and in a large team all but those that can touch something, with those that they could
//! push.
//!
//! Each robot has a budget: the way that it may go before it can touch something. It is the distance to the
//! nearest wall or piece of debris, or half the distance to the nearest robot, whichever is less. A robot
//! that has used it up is measured again. So a step costs little for robots far from everything.

use std::mem;

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use autonomy::by_x::{ByX, Spot};

/// Bodies with at least this gap, in metres, beyond the way that they go in a step, do not touch.
const GAP_M: f32 = 0.005;

/// Things farther than this from a robot are not measured, in metres: in a small team, and in a large one.
const REACH_M: [f32; 2] = [4.0, 1.0];

/// Ways are taken for longer by this share, and by the next constant in metres: what comes of rounding.
const ROUNDING: f32 = 1.01;
const ROUNDING_M: f32 = 1.0e-5;

/// How many times as fast as the fastest robot a robot may be pushed, on the safe side: from the side, by a
/// robot as fast as itself, it gets 1.41 times as fast.
const PUSHED: f32 = 2.0;

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
#[derive(Default, Serialize, Deserialize)]
pub(crate) struct Quiet {
    /// Length of a step, in seconds.
    #[serde(skip)]
    pub dt: f32,
    /// Width and height of the arena, in metres.
    #[serde(skip)]
    pub arena: Vector,
    /// The robots, by id.
    pub discs: Vec<Disc>,
    /// Whether only those move with the engine that can touch something, with those that they could push.
    #[serde(skip)]
    pub by_island: bool,
    /// The budget of each robot, in metres. Budgets only save time: those that are missing are measured.
    #[serde(skip)]
    budgets: Vec<f32>,
    /// Whether each robot moves with the engine in this step.
    #[serde(skip)]
    near: Vec<bool>,
    /// Of these, robots whose neighbours are not looked at yet.
    #[serde(skip)]
    open: Vec<usize>,
    /// The greatest radius, in metres.
    #[serde(skip)]
    largest: f32,
    /// The robots of a large team in order along x.
    #[serde(skip)]
    by_x: ByX,
    /// Whether they are in the order of this step: from its first measurement on.
    #[serde(skip)]
    is_sorted: bool,
}

impl Quiet {
    /// Discs in an arena, in steps of `dt` seconds.
    pub(crate) fn new(dt: f32, arena: Vector, discs: Vec<Disc>) -> Self {
        Self { dt, arena, discs, ..Self::default() }
    }

    /// Has everything measured again: something other than a robot has moved.
    pub(crate) fn forget(&mut self) {
        self.budgets.clear();
    }

    /// Finds the robots that move with the engine in this step. Returns whether there are any. `to_debris` is
    /// the distance from a point to the nearest piece of debris, at most the given reach, in metres;
    /// `to_pushable`, to the nearest that can be pushed.
    pub(crate) fn find_near(
        &mut self,
        to_debris: impl Fn(Vector, f32) -> f32,
        to_pushable: impl Fn(Vector, f32) -> f32,
    ) -> bool {
        self.is_sorted = false;
        self.budgets.resize(self.discs.len(), 0.0);
        self.take(false);
        for i in 0..self.discs.len() {
            if self.budgets[i] > self.least(i) || self.is_free(i, &to_debris) {
                continue;
            }
            self.open.push(i);
            if !self.by_island {
                break;
            }
        }
        let is_any = !self.open.is_empty();
        if is_any && !(self.by_island && self.add_pushed(to_pushable)) {
            self.take(true);
        }
        is_any
    }

    /// Adds the robots that those so far could push in this step, those that these could push, and so on.
    /// Returns whether all are found: what a piece of debris pushes is not looked for.
    fn add_pushed(&mut self, to_pushable: impl Fn(Vector, f32) -> f32) -> bool {
        let speeds = self.discs.iter().map(|disc| disc.velocity.length_squared());
        let way = GAP_M + (1.0 + PUSHED) * speeds.fold(0.0, f32::max).sqrt() * self.dt * ROUNDING;
        self.open.iter().for_each(|i| self.near[*i] = true);
        while let Some(i) = self.open.pop() {
            let me = self.discs[i];
            let reach = me.fixed.radius + way;
            if !me.fixed.is_aerial && to_pushable(me.at, reach) < reach {
                return false;
            }
            for (j, spot) in self.by_x.within(me.at, reach + self.largest) {
                let touch = reach + self.discs[j].fixed.radius;
                let is_in_reach = (spot.at - me.at).length_squared() <= touch * touch;
                if is_in_reach && spot.is_aerial == me.fixed.is_aerial && !self.near[j] {
                    self.near[j] = true;
                    self.open.push(j);
                }
            }
        }
        true
    }

    /// Has every robot move with the engine in this step, or none.
    pub(crate) fn take(&mut self, all: bool) {
        self.open.clear();
        self.near.clear();
        self.near.resize(self.discs.len(), all);
    }

    /// Whether a robot moves with the engine in this step.
    pub(crate) fn is_near(&self, i: usize) -> bool {
        self.near[i]
    }

    /// The least budget with which a robot cannot touch anything in this step, in metres.
    fn least(&self, i: usize) -> f32 {
        GAP_M + self.discs[i].velocity.length() * self.dt * ROUNDING
    }

    /// Measures how far a robot may go. Returns whether it can touch nothing in this step.
    fn is_free(&mut self, i: usize, to_debris: impl Fn(Vector, f32) -> f32) -> bool {
        let (me, reach) = (self.discs[i], REACH_M[usize::from(self.by_island)]);
        let inside = me.at.min(self.arena - me.at).min_element();
        let debris = if me.fixed.is_aerial { reach } else { to_debris(me.at, reach) };
        let fixed = inside.min(debris).min(reach) - me.fixed.radius;
        let is_clear = fixed > self.least(i); // false where a number is not finite: the engine tells
        self.sort(); // also for those who look for what this robot could push
        if !is_clear {
            return false;
        }
        let Self { discs, budgets, by_x, .. } = self;
        let (dt, mut budget) = (self.dt, fixed);
        let keeps_clear = |j: usize| {
            let other = &discs[j];
            if j == i || other.fixed.is_aerial != me.fixed.is_aerial {
                return true;
            }
            let touch = me.fixed.radius + other.fixed.radius;
            let (apart, far) = ((other.at - me.at).length_squared(), touch + 2.0 * reach);
            if apart >= far * far {
                return true;
            }
            let gap = apart.sqrt() - touch;
            budget = budget.min(0.5 * gap);
            budgets[j] = budgets[j].min(0.5 * gap);
            gap > GAP_M + (me.velocity - other.velocity).length() * dt * ROUNDING
        };
        let is_free = if self.by_island {
            let far = me.fixed.radius + self.largest + 2.0 * reach;
            by_x.within(me.at, far).map(|(j, _)| j).all(keeps_clear)
        } else {
            (0..discs.len()).all(keeps_clear)
        };
        if is_free {
            self.budgets[i] = budget;
        }
        is_free
    }

    /// Puts the robots of a large team in order along x, once a step.
    fn sort(&mut self) {
        if self.by_island && !mem::replace(&mut self.is_sorted, true) {
            let Self { discs, by_x, largest, .. } = self;
            by_x.sort(discs.len(), |i| Spot { at: discs[i].at, is_aerial: discs[i].fixed.is_aerial });
            *largest = discs.iter().map(|disc| disc.fixed.radius).fold(0.0, f32::max);
        }
    }

    /// Moves the robots that do not move with the engine, as it would move them.
    pub(crate) fn coast(&mut self) {
        let part = self.dt / f32::from(PARTS);
        for ((disc, budget), is_near) in self.discs.iter_mut().zip(&mut self.budgets).zip(&self.near) {
            if *is_near || disc.velocity == Vector::ZERO {
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
        assert!(!quiet(&[disc(5.0, 1.0), disc(6.0, -1.0)]).find_near(nothing, nothing));
        assert!(
            quiet(&[disc(5.0, 1.0), disc(5.84, -1.0)]).find_near(nothing, nothing),
            "they meet in this step"
        );
        assert!(
            !quiet(&[disc(5.0, 1.0), disc(5.81, 1.0)]).find_near(nothing, nothing),
            "in step, side by side"
        );
        assert!(quiet(&[disc(0.41, -1.0)]).find_near(nothing, nothing), "at the border");
        assert!(quiet(&[disc(5.0, 1.0)]).find_near(|_, _| 0.42, nothing), "at debris");
        let mut flying = disc(5.84, -1.0);
        flying.fixed.is_aerial = true;
        assert!(!quiet(&[disc(5.0, 1.0), flying]).find_near(nothing, nothing), "above");
        assert!(quiet(&[disc(5.0, f32::NAN)]).find_near(nothing, nothing), "not a number");
    }

    #[test]
    fn no_touch_is_missed_on_the_way() {
        let nothing = |_: Vector, reach: f32| reach;
        let (mut moving, wall) = (quiet(&[disc(5.0, 2.0), disc(12.0, -0.5)]), 16.0);
        let to_wall = |at: Vector, reach: f32| (wall - at.x).min(reach);
        let steps = (0..1000).position(|_| {
            let is_any = moving.find_near(to_wall, nothing);
            moving.coast();
            is_any
        });
        let gap = (12.0 - 5.0 - 0.8) - 2.5 * 0.02 * steps.unwrap() as f32;
        assert!((0.0..0.06).contains(&gap), "{gap} m apart");
        let measured = std::cell::Cell::new(0);
        let mut alone = quiet(&[disc(5.0, 0.1)]);
        for _ in 0..100 {
            assert!(!alone.find_near(
                |at, reach| {
                    measured.set(measured.get() + 1);
                    to_wall(at, reach)
                },
                nothing
            ));
            alone.coast();
        }
        assert_eq!(measured.get(), 1, "far from everything, nothing is measured");
    }

    #[test]
    fn in_a_large_team_only_those_near_one_another_move_with_the_engine() {
        let nothing = |_: Vector, reach: f32| reach;
        // The first runs into the second, which can be pushed into the third; the others are elsewhere.
        let mut team =
            quiet(&[disc(2.0, 2.0), disc(2.82, 0.0), disc(3.68, 0.0), disc(6.0, 1.0), disc(9.0, 0.0)]);
        team.by_island = true;
        assert!(team.find_near(nothing, nothing));
        assert_eq!(team.near, [true, true, true, false, false]);
        team.coast();
        let expected = [2.0, 2.82, 3.68, 6.02, 9.0];
        assert!(team.discs.iter().zip(expected).all(|(disc, x)| (disc.at.x - x).abs() < 1e-5));
        assert!(team.find_near(nothing, |at, _| (at.x - 4.1).abs()), "a piece beside the third");
        assert_eq!(team.near, [true; 5]);
    }
}
