//! The sense of oneself: where a robot is and how it moves, its levels, its resources and its load, and
//! whether it can act. It is exact.

use crate::belief::KnownRobot;
use crate::robot::RobotState;
use crate::world::Robot;

/// What a robot has to report of itself, if it is not as it is known.
pub(crate) fn sense<'w>(robot: &'w Robot, known: &KnownRobot) -> Option<&'w RobotState> {
    (!robot.is_as(known)).then_some(robot)
}
