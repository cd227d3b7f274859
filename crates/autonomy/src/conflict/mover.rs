//! What the resolver knows of a robot, and the directive that it returns.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use super::PriorityKey;
use crate::ids::RobotId;
use crate::model::Brakes;
use crate::planning::{ObstacleMap, Passage};
use crate::report::Track;

/// A robot as the resolver sees it.
#[derive(Debug, Clone, Copy)]
pub struct Mover<'a> {
    /// Identity.
    pub robot: RobotId,
    /// Whether it flies; robots of different layers do not meet.
    pub aerial: bool,
    /// Centre, in metres.
    pub position: Vector,
    /// Velocity, in metres per second.
    pub velocity: Vector,
    /// The preferred velocity, in metres per second; zero for a robot with nowhere to go.
    pub preferred: Vector,
    /// Distance left to the place where it makes room, in metres; none for a robot that is not going to such
    /// a place.
    pub retreat_left: Option<f32>,
    /// Steps since it last came nearer to its goal.
    pub stalled_steps: u32,
    /// Distance left to its next waypoint, in metres.
    pub leg_left: f32,
    /// Waypoints ahead.
    pub route: &'a [Vector],
    /// Narrow passages of the route.
    pub passages: &'a [Passage],
    /// Places that it passed, the latest last.
    pub trail: &'a [Vector],
    /// Radius, in metres.
    pub radius: f32,
    /// Present top speed, in metres per second.
    pub speed: f32,
    /// How it plans to brake.
    pub brakes: Brakes,
    /// Its claim to the right of way.
    pub priority: PriorityKey,
    /// The obstacles that it knows; none for aerial robots.
    pub known: Option<&'a ObstacleMap>,
    /// Whether it may be asked to make room: not while it loads or rests, nor when it is stranded or
    /// disabled.
    pub can_make_room: bool,
}

impl Mover<'_> {
    /// Where it is and how it moves.
    pub(super) fn track(&self) -> Track {
        Track { position: self.position, velocity: self.velocity }
    }

    pub(super) fn wishes_to_move(&self) -> bool {
        self.preferred != Vector::ZERO
    }

    /// Another robot as this one sees it: its index, its centre relative to this robot's, and the distance at
    /// which the two touch.
    pub(super) fn sees(&self, other: usize, movers: &[Mover]) -> (usize, Vector, f32) {
        let (at, radius) = (movers[other].position, movers[other].radius);
        (other, at - self.position, self.radius + radius)
    }

    /// Distance left to the place where it makes room, or else to the end of its route, in metres.
    pub(super) fn way_left(&self) -> f32 {
        let starts = std::iter::once(&self.position).chain(self.route);
        self.retreat_left.unwrap_or_else(|| starts.zip(self.route).map(|(a, b)| (*b - *a).length()).sum())
    }
}

/// What a robot is to do in this step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Directive {
    /// Move with this velocity.
    Proceed(Vector),
    /// Stop, and let another robot pass.
    Yield {
        /// The robot that it waits for.
        to: RobotId,
    },
    /// Move with this velocity to a place where another robot can pass, or stand there until it has passed.
    Retreat {
        /// Metres per second.
        velocity: Vector,
        /// The robot for which it makes room.
        room_for: RobotId,
    },
    /// Make room sideways with this velocity: the whole set is deadlocked.
    BackOff(Vector),
    /// Move out of the way of others with this velocity: the robot has nowhere to go.
    GiveWay(Vector),
    /// Stop: no direction is free at the moment.
    Blocked {
        /// The robot in the way, if a robot is.
        by: Option<RobotId>,
    },
    /// Stand: the robot has nowhere to go.
    Stand,
    /// Move with this low velocity behind another robot: it queues behind it, or comes no nearer because of
    /// it.
    Follow {
        /// Metres per second.
        velocity: Vector,
        /// The robot ahead.
        behind: RobotId,
    },
}

impl Directive {
    /// The directive that grants a preferred velocity as it is.
    pub(super) fn granted(preferred: Vector) -> Self {
        if preferred == Vector::ZERO { Self::Stand } else { Self::Proceed(preferred) }
    }

    /// The same with another velocity; a robot that is to stop still stops.
    pub(super) fn set_velocity(&mut self, to: Vector) {
        match self {
            Self::Proceed(velocity)
            | Self::BackOff(velocity)
            | Self::GiveWay(velocity)
            | Self::Retreat { velocity, .. }
            | Self::Follow { velocity, .. } => *velocity = to,
            Self::Yield { .. } | Self::Blocked { .. } | Self::Stand => {}
        }
    }

    /// The velocity that the drive is to reach.
    pub fn velocity(self) -> Vector {
        match self {
            Self::Proceed(velocity)
            | Self::BackOff(velocity)
            | Self::GiveWay(velocity)
            | Self::Retreat { velocity, .. }
            | Self::Follow { velocity, .. } => velocity,
            Self::Yield { .. } | Self::Blocked { .. } | Self::Stand => Vector::ZERO,
        }
    }

    /// The robot that it waits for, if there is one.
    pub fn waits_for(self) -> Option<RobotId> {
        match self {
            Self::Yield { to } => Some(to),
            Self::Follow { behind, .. } => Some(behind),
            Self::Blocked { by } => by,
            Self::Retreat { velocity, room_for } if velocity == Vector::ZERO => Some(room_for),
            _ => None,
        }
    }
}
