//! The journey of one robot: its goal, its route, and its progress.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use crate::belief::Seen;
use crate::planning::{Passage, Passages, Route};

/// An approach by less than this is no progress, in metres.
pub(super) const PROGRESS_M: f32 = 0.05;

/// A robot is at the end of its route within this distance, in metres.
const ROUTE_END_M: f32 = 0.15;

/// Where a robot wants to be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Goal {
    /// The place.
    pub point: Vector,
    /// Distance from the place within which the robot has arrived, in metres.
    pub within: f32,
}

/// An attempt of a robot that comes no nearer to its goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Attempt {
    /// A route round the robots that stand nearby.
    Detour,
    /// A route that ignores standing robots: a robot in the way is asked to make room.
    Straight,
}

/// The journey of one robot.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Traveller {
    pub(super) goal: Option<Goal>,
    pub(super) route: Option<Route>,
    /// Narrow passages of the route.
    pub(super) passages: Passages,
    pub(super) is_planned: bool,
    pub(super) seen: Seen,
    /// Least length that the route ahead has had, in metres.
    best_length: f32,
    /// Steps since the robot last came nearer to its goal.
    stalled_steps: u64,
    /// Steps since the robot last knew a route.
    lost_steps: u64,
    /// Where it last found no route. From there it finds none as long as it hears of nothing new.
    #[serde(skip)]
    lost_at: Option<Vector>,
    /// The length of the route ahead, as it was measured last. It only saves time.
    #[serde(skip)]
    measured: Option<Measured>,
    /// Where it was when it was seen at its goal, or without one, last. It only saves time.
    #[serde(skip)]
    settled_at: Option<Vector>,
}

/// The length of a route ahead.
#[derive(Debug, Clone, Copy)]
struct Measured {
    from: Vector,
    next: usize,
    length: f32,
}

impl Traveller {
    pub(super) fn to(goal: Option<Goal>) -> Self {
        Self {
            goal,
            route: None,
            passages: Passages::default(),
            is_planned: false,
            seen: Seen::default(),
            best_length: f32::INFINITY,
            stalled_steps: 0,
            lost_steps: 0,
            lost_at: None,
            measured: None,
            settled_at: None,
        }
    }

    /// Whether the robot was seen at its goal, or without one, at this very place.
    pub(crate) fn is_settled_at(&self, position: Vector) -> bool {
        self.settled_at == Some(position)
    }

    /// Notes whether the robot is at its goal, or has none.
    pub(super) fn settle(&mut self, position: Vector) -> bool {
        let is_there = self.goal.is_none() || self.has_arrived(position);
        self.settled_at = is_there.then_some(position);
        is_there
    }

    /// Length of the route ahead from a position, in metres; none without a route.
    pub(super) fn length(&self, from: Vector) -> Option<f32> {
        let route = self.route.as_ref()?;
        let is_same = |measured: &Measured| measured.from == from && measured.next == route.next();
        Some(self.measured.filter(is_same).map_or_else(|| route.length(from), |measured| measured.length))
    }

    /// The same, kept for the next time.
    pub(crate) fn measure(&mut self, from: Vector) -> Option<f32> {
        let length = self.length(from)?;
        let next = self.route.as_ref()?.next();
        self.measured = Some(Measured { from, next, length });
        Some(length)
    }

    /// The goal of the robot, if it has one.
    pub fn goal(&self) -> Option<Goal> {
        self.goal
    }

    /// The route, if there is one.
    pub fn route(&self) -> Option<&Route> {
        self.route.as_ref()
    }

    /// The narrow passages of the route.
    pub fn passages(&self) -> &[Passage] {
        &self.passages.found
    }

    /// Whether a robot at this position is at its goal, or at the end of its route.
    pub fn has_arrived(&self, position: Vector) -> bool {
        self.goal.is_some_and(|goal| is_near(position, goal.point, goal.within))
            || self.route.as_ref().is_some_and(|route| is_near(position, route.end(), ROUTE_END_M))
    }

    /// Steps since the robot last came nearer to its goal.
    pub fn stalled_steps(&self) -> u64 {
        self.stalled_steps
    }

    /// Whether the planner found no route to the goal.
    pub fn leads_nowhere(&self) -> bool {
        self.goal.is_some() && self.is_planned && self.route.is_none()
    }

    /// Steps for which the robot has known no route to its goal.
    pub(crate) fn lost_steps(&self) -> u64 {
        self.lost_steps
    }

    /// Whether a robot without a route found none from this very place.
    pub(super) fn is_lost_at(&self, position: Vector) -> bool {
        self.lost_at == Some(position)
    }

    /// The next attempt of a robot that comes no nearer to its goal, if an attempt is due.
    pub(super) fn attempt(&self, detour_steps: u64) -> Option<Attempt> {
        if self.stalled_steps == 0 || !self.stalled_steps.is_multiple_of(detour_steps) {
            return None;
        }
        match self.stalled_steps / detour_steps % 4 {
            1 => Some(Attempt::Detour),
            0 => Some(Attempt::Straight),
            _ => None,
        }
    }

    /// Whether a route leads as near to the goal as the present one. A detour must not end farther from the
    /// goal.
    pub(super) fn is_as_near(&self, route: Option<&Route>, goal: Goal) -> bool {
        let apart = |route: &Route| (route.end() - goal.point).length();
        let (found, present) = (route.map(apart), self.route.as_ref().map(apart));
        present.is_none_or(|present| found.is_some_and(|found| found <= present + ROUTE_END_M))
    }

    pub(super) fn set_route(&mut self, route: Option<Route>, position: Vector, fresh: bool) {
        if let Some(route) = route.as_ref().filter(|_| fresh) {
            self.best_length = route.length(position);
            self.stalled_steps = 0;
        }
        self.lost_at = if route.is_some() { None } else { Some(position) };
        (self.route, self.passages) = (route, Passages::default());
        (self.measured, self.settled_at) = (None, None);
        self.is_planned = true;
    }

    pub(super) fn note_progress(&mut self, position: Vector) {
        self.lost_steps = if self.leads_nowhere() { self.lost_steps + 1 } else { 0 };
        let length = self.measure(position).unwrap_or(f32::INFINITY);
        if length < self.best_length - PROGRESS_M {
            self.best_length = length;
            self.stalled_steps = 0;
        } else {
            self.stalled_steps += 1;
        }
    }
}

fn is_near(position: Vector, place: Vector, within: f32) -> bool {
    (place - position).length_squared() <= within * within
}
