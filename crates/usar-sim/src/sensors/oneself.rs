//! The sensor of oneself: a robot's own place, motion, levels, resources and load.

use crate::report::{Report, Speaker, Statement};
use crate::robot::Robot;

/// Lets each robot report its state, if it is not the one in which the team believes it to be.
pub(crate) fn sense(robots: &[Robot], believed: &[Robot], step: u64, sent: &mut Vec<Report>) {
    for (robot, believed) in robots.iter().zip(believed) {
        if !robot.is_as(believed) {
            sent.push(report(robot, step));
        }
    }
}

/// A robot's report of itself.
pub(crate) fn report(robot: &Robot, step: u64) -> Report {
    Report { from: Speaker::Robot(robot.id), says: Statement::IAm(robot.clone()), at_step: step, sd_m: 0.0 }
}
