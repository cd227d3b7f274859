//! The priority key: one comparable value that decides who goes first.

use std::cmp::Ordering;

use crate::ids::RobotId;

/// Lowest energy first, because the robot with the least left can least afford to wait; then the lowest id.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PriorityKey {
    /// Battery level, in percent.
    pub energy: f64,
    /// Identity.
    pub robot: RobotId,
}

impl PriorityKey {
    /// `Less` goes first. A total order: no two robots have the same id.
    #[must_use]
    pub fn precedence(&self, other: &Self) -> Ordering {
        self.energy.total_cmp(&other.energy).then(self.robot.cmp(&other.robot))
    }
}
