//! The beliefs of a team, and which robots share which. What a member of a group hears, all members know.
//! Robots without a group share the belief of the team at home.

use rne_core::TaskId;
use serde::{Deserialize, Serialize};

use super::{Belief, Inflation};
use crate::ids::RobotId;
use crate::report::{Report, Speaker};

/// The beliefs of all groups, and of the team at home.
#[derive(Serialize, Deserialize)]
pub struct Beliefs {
    groups: Vec<Belief>,
    home: Belief,
}

impl Beliefs {
    /// Beliefs about nothing.
    #[must_use]
    pub fn nothing(tasks: usize, inflation: Inflation) -> Self {
        let home = Belief::nothing(inflation);
        Self { groups: vec![home.clone(); tasks], home }
    }

    /// The belief of the group of a task, or of the team at home. The latter is what all groups had heard when
    /// the last round ended, and what robots without a group have reported since.
    #[must_use]
    pub fn of(&self, group: Option<TaskId>) -> &Belief {
        group.map_or(&self.home, |task| &self.groups[task.index()])
    }

    /// Lets a report be heard by all who share the sender's belief, or by all groups if the base speaks.
    /// `group_of` is a function from a robot to its group. Returns whether the report was newer than what the
    /// sender's belief had heard before.
    pub(crate) fn hear(&mut self, report: &Report, group_of: impl Fn(RobotId) -> Option<TaskId>) -> bool {
        match report.from {
            Speaker::Robot(robot) => {
                let group = group_of(robot).map(|task| &mut self.groups[task.index()]);
                group.unwrap_or(&mut self.home).hear(report)
            }
            Speaker::Base => {
                self.groups.iter_mut().for_each(|group| {
                    group.hear(report);
                });
                self.home.hear(report)
            }
        }
    }

    /// The team at home hears all that the groups have heard.
    pub(crate) fn pool(&mut self) {
        self.home.pool(&self.groups);
    }

    /// A group leaves home with the belief of the team.
    pub(crate) fn depart(&mut self, task: TaskId) {
        self.groups[task.index()] = self.home.clone();
    }

    /// Makes again what a snapshot leaves out.
    pub(crate) fn restore(&mut self, inflation: &Inflation) {
        self.groups.iter_mut().chain([&mut self.home]).for_each(|belief| belief.restore(inflation));
    }
}
