//! The beliefs of a team, and which robots share which. What a member of a group hears, all members know.
//! Robots without a group share the belief of the team at home. What a robot says of itself, the whole team
//! knows.

use rne_core::TaskId;
use serde::{Deserialize, Serialize};

use super::fold::Belief;
use super::ledger::Ledger;
use crate::ids::RobotId;
use crate::planning::Inflation;
use crate::report::{Report, Speaker};
use crate::robot::Robot;

/// The beliefs of all groups, and of the team at home.
#[derive(Serialize, Deserialize)]
pub struct Beliefs {
    groups: Vec<Belief>,
    home: Belief,
    /// The robots as they last said they are, by id.
    pub team: Vec<Robot>,
    /// The step as of which each robot said so.
    said_at: Vec<u64>,
    /// What the base knows of the rounds.
    pub ledger: Ledger,
}

impl Beliefs {
    /// Beliefs about nothing but the team.
    #[must_use]
    pub fn nothing(tasks: usize, inflation: &Inflation, team: Vec<Robot>) -> Self {
        let home = Belief::nothing(inflation);
        let (said_at, ledger) = (vec![0; team.len()], Ledger::empty(team.len()));
        Self { groups: vec![home.clone(); tasks], home, team, said_at, ledger }
    }

    /// The belief of the group of a task, or of the team at home. The latter is what all groups had heard when
    /// the last round ended, and what robots without a group have reported since.
    #[must_use]
    pub fn of(&self, group: Option<TaskId>) -> &Belief {
        group.map_or(&self.home, |task| &self.groups[task.index()])
    }

    /// Lets a robot's report of itself be heard by the whole team. An older one than the last changes nothing.
    pub(crate) fn hear_of_self(&mut self, id: RobotId, robot: Robot, at_step: u64) {
        let last = &mut self.said_at[id.index()];
        if *last <= at_step {
            *last = at_step;
            let known = &mut self.team[id.index()];
            self.ledger.note_levels(id, [known.energy, known.hp], [robot.energy, robot.hp]);
            known.be_as(robot);
        }
    }

    /// Lets a report be heard by all who share the sender's belief, or by the whole team if the base speaks.
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

    /// Draws the maps of all beliefs again, after a snapshot was read.
    pub(crate) fn draw_maps(&mut self, inflation: &Inflation) {
        self.groups.iter_mut().chain([&mut self.home]).for_each(|belief| belief.draw_maps(inflation));
    }
}
