//! The numbers under which robots speak of rescuees: those of real ones as an exact sight has them, those of
//! such as are made up, and those of such as are seen with errors.

use std::ops::Range;

use teaming::TaskId;

use super::Model;
use crate::ids::{RescueeId, RobotId};

impl Model {
    /// How many numbers robots have for rescuees.
    pub(crate) fn rescuee_numbers(&self) -> usize {
        let seen = if self.has_sight_errors { self.rescuees.len() * self.robots.len() } else { 0 };
        self.first_seen() + seen
    }

    /// The numbers under which robots speak of rescuees of a task.
    pub(crate) fn names_of(&self, task: TaskId) -> [Range<usize>; 3] {
        let own = &self.tasks[task.index()].rescuees;
        let seen = |rescuee: usize| self.first_seen() + rescuee * self.robots.len();
        let seen = if self.has_sight_errors { seen(own.start)..seen(own.end) } else { 0..0 };
        [own.clone(), self.phantoms_of(task), seen]
    }

    /// The numbers of the rescuees of a task that do not exist, one for each robot that makes them up or sees
    /// them.
    pub fn phantoms_of(&self, task: TaskId) -> Range<usize> {
        let robots = if self.has_phantoms { self.robots.len() } else { 0 };
        let first = self.rescuees.len() + task.index() * robots;
        first..first + robots
    }

    /// The number of the rescuee of a task that does not exist and that this robot speaks of.
    pub fn phantom_of(&self, task: TaskId, robot: RobotId) -> RescueeId {
        RescueeId((self.phantoms_of(task).start + robot.index()) as u32)
    }

    /// The number under which a robot speaks of a rescuee that it sees with errors.
    pub fn seen_as(&self, rescuee: RescueeId, robot: RobotId) -> RescueeId {
        RescueeId((self.first_seen() + rescuee.index() * self.robots.len() + robot.index()) as u32)
    }

    fn first_seen(&self) -> usize {
        self.rescuees.len() + if self.has_phantoms { self.tasks.len() * self.robots.len() } else { 0 }
    }
}
