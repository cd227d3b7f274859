//! Intents: what robots want to do to the world where they are, and what comes of it.

use parry2d::math::Vector;
use smallvec::SmallVec;

use crate::event::Place;
use crate::ids::{RescueeId, RobotId};

/// A rescuee that a robot is after. The world goes by the place: the number is the robot's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sought {
    /// Its number.
    pub rescuee: RescueeId,
    /// Where it is believed to wait.
    pub at: Vector,
    /// Standard deviation of that place, in metres.
    pub sd_m: f32,
}

/// What a robot wants to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Intent {
    /// To begin to load a rescuee, for a resource of `resource_of`.
    BeginLoading {
        /// The rescuee.
        sought: Sought,
        /// The robot itself, or a team-mate.
        resource_of: RobotId,
    },
    /// To take the rescuee on board that it was loading.
    Load {
        /// The rescuee.
        sought: Sought,
        /// The robot itself, or a team-mate.
        resource_of: RobotId,
    },
    /// To deliver all rescuees on board.
    Deliver {
        /// Where.
        place: Place,
    },
    /// To end a rest with these levels (energy and HP), in percent.
    Refill {
        /// The levels.
        levels: [f64; 2],
    },
}

/// What came of an intent.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// The robot loads the rescuee now.
    LoadingBegan(RescueeId),
    /// The rescuee is on board.
    Loaded {
        /// The number under which the robot was after it.
        sought: RescueeId,
        /// The rescuee.
        rescuee: RescueeId,
        /// The robot whose resource was used.
        resource_of: RobotId,
    },
    /// The rescuee does not wait within reach.
    NotThere(RescueeId),
    /// Another robot is loading the rescuee.
    Taken(RescueeId),
    /// There is no resource for the rescuee.
    NoResource(RescueeId),
    /// The robot has no room left.
    NoRoom(RescueeId),
    /// The rescuees are delivered.
    Delivered {
        /// Where.
        place: Place,
        /// The rescuees.
        rescuees: SmallVec<[RescueeId; 8]>,
    },
    /// The levels are refilled.
    Refilled,
}
