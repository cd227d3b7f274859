//! The beliefs of a team, and which robots share which: by the scenario's rule, those of a group, or each
//! robot in the field has its own and may hear from its mates. Robots without a group share the belief of the
//! team at home. What a robot says of itself, the whole team knows.

use std::sync::Arc;

use scenario::BeliefSharing;
use serde::{Deserialize, Serialize};
use teaming::TaskId;

use super::fold::Belief;
use super::ledger::Ledger;
use super::robot::KnownRobot;
use crate::ids::RobotId;
use crate::model::RobotModel;
use crate::planning::Inflation;
use crate::report::{Report, Speaker};
use crate::robot::RobotState;

/// The place of a belief in the field: of a group, or of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Holder(u32);

impl Holder {
    /// Number of beliefs in the field.
    pub fn count(sharing: BeliefSharing, tasks: usize, robots: usize) -> usize {
        match sharing {
            BeliefSharing::WithGroup => tasks,
            BeliefSharing::WithNobody | BeliefSharing::ByRadio => robots,
        }
    }

    /// The belief of a robot in the group of a task.
    pub fn of(sharing: BeliefSharing, robot: RobotId, task: TaskId) -> Self {
        match sharing {
            BeliefSharing::WithGroup => Self(u32::from(task.0)),
            BeliefSharing::WithNobody | BeliefSharing::ByRadio => Self(robot.0),
        }
    }

    /// The beliefs of these members of the group of a task, each once. A group has one without members, too.
    pub fn all_in(sharing: BeliefSharing, task: TaskId, members: &[RobotId]) -> impl Iterator<Item = Self> {
        let is_shared = sharing == BeliefSharing::WithGroup;
        let of_group = is_shared.then_some(Self(u32::from(task.0)));
        let own = members.iter().filter(move |_| !is_shared);
        of_group.into_iter().chain(own.map(|robot| Self(robot.0)))
    }
}

/// The beliefs in the field, and of the team at home.
#[derive(Serialize, Deserialize)]
pub struct Beliefs {
    field: Vec<Belief>,
    home: Belief,
    /// The robots as they are known, by id.
    pub team: Vec<KnownRobot>,
    /// What the base knows of the rounds.
    pub ledger: Ledger,
}

impl Beliefs {
    /// Beliefs about nothing but a team that is at home.
    pub fn nothing(holders: usize, inflation: &Inflation, team: &[Arc<RobotModel>]) -> Self {
        let home = Belief::nothing(inflation);
        let (ledger, team) = (Ledger::empty(team.len()), team.iter().map(KnownRobot::new).collect());
        Self { field: vec![home.clone(); holders], home, team, ledger }
    }

    /// A belief in the field, or that of the team at home. The latter is what all had heard when the last
    /// round ended, and what robots without a group have reported since.
    pub fn of(&self, holder: Option<Holder>) -> &Belief {
        holder.map_or(&self.home, |holder| &self.field[holder.0 as usize])
    }

    /// The whole team hears at once what a robot reports of itself.
    pub fn hear_of_self(&mut self, state: &RobotState, at_step: u64) {
        let known = &mut self.team[state.id.index()];
        self.ledger.note_levels(state.id, [known.energy, known.hp], [state.energy, state.hp]);
        known.hear(state, at_step);
    }

    /// Lets a report be heard by all who share the sender's belief, or by the whole team if the base speaks.
    /// `holder_of` is a function from a robot to its belief. Returns whether the report was newer than what
    /// the sender's belief had heard before.
    pub fn hear(&mut self, report: &Report, holder_of: impl Fn(RobotId) -> Option<Holder>) -> bool {
        match report.from {
            Speaker::Robot(robot) => {
                let own = holder_of(robot).map(|holder| &mut self.field[holder.0 as usize]);
                own.unwrap_or(&mut self.home).hear(report)
            }
            Speaker::Base => {
                self.field.iter_mut().for_each(|belief| {
                    belief.hear(report);
                });
                self.home.hear(report)
            }
        }
    }

    /// Lets a report be heard by those who share one belief in the field.
    pub fn hear_in_field(&mut self, holder: Holder, report: &Report) {
        self.field[holder.0 as usize].hear(report);
    }

    /// The beliefs as they count in the hash chain.
    pub fn to_hash(&self) -> impl Serialize + '_ {
        let Self { field, home, team, ledger } = self;
        let field: Vec<u128> = field.iter().map(Belief::digest).collect();
        (field, home.digest(), KnownRobot::to_hash(team), ledger.to_hash())
    }

    /// The team at home hears all that was heard in the field.
    pub(crate) fn pool(&mut self) {
        self.home.pool(&self.field);
    }

    /// A group or a robot leaves home with the belief of the team.
    pub(crate) fn depart(&mut self, holder: Holder) {
        self.field[holder.0 as usize] = self.home.clone();
    }

    /// Draws the maps of all beliefs again, after a snapshot was read.
    pub fn draw_maps(&mut self, inflation: &Inflation) {
        self.field.iter_mut().chain([&mut self.home]).for_each(|belief| belief.draw_maps(inflation));
    }
}
