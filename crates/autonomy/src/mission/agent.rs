//! The activity of each robot in the mission.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};
use teaming::TaskId;

use super::progress::Progress;
use crate::ids::RescueeId;

/// The activity of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Activity {
    /// At its home, waiting for the next round.
    Home,
    /// On its way to the task area, or sweeping it for rescuees.
    Searching,
    /// On its way to a rescuee.
    Approaching(RescueeId),
    /// Loading a rescuee until the given step.
    Loading(RescueeId, u64),
    /// In the task area, or at the end of its errands, with nothing to do.
    Standby,
    /// On its way to the next place of its errand.
    OnErrand,
    /// On its way home.
    Returning,
    /// On its way to a rest place.
    ToRest,
    /// Resting until the given step.
    Resting(u64),
}

impl Activity {
    /// The activity as one word, for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Home => "home",
            Self::Searching => "searching",
            Self::Approaching(_) => "approaching",
            Self::Loading(..) => "loading",
            Self::Standby => "standby",
            Self::OnErrand => "on_errand",
            Self::Returning => "returning",
            Self::ToRest => "to_rest",
            Self::Resting(_) => "resting",
        }
    }

    /// Whether the robot works in the field: it is not at home, on its way back, resting, or on an errand.
    pub fn is_in_field(self) -> bool {
        matches!(self, Self::Searching | Self::Approaching(_) | Self::Loading(..) | Self::Standby)
    }

    /// Whether the robot is at home, or on its way home or to rest. The team may wait for it.
    pub(crate) fn is_way_back(self) -> bool {
        matches!(self, Self::Home | Self::Returning | Self::ToRest)
    }

    /// Whether the robot rests, or is on its way to rest.
    pub fn is_rest(self) -> bool {
        matches!(self, Self::ToRest | Self::Resting(_))
    }

    /// The rescuee that the robot has claimed.
    pub fn claim(self) -> Option<RescueeId> {
        match self {
            Self::Approaching(rescuee) | Self::Loading(rescuee, _) => Some(rescuee),
            _ => None,
        }
    }
}

/// A robot's part in the mission.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Agent {
    /// Its activity.
    pub activity: Activity,
    /// The task of its group in this round; `None` for a robot that is not grouped.
    pub task: Option<TaskId>,
    /// The task at whose rest place it rests.
    pub rest_at: TaskId,
    /// Places still to pass on its sweep of the task area, or on its errand; the next one last.
    pub sweep: Vec<Vector>,
    /// Where it waits when it has nothing to do.
    pub muster: Vector,
    /// Energy and HP at the beginning of the round; none once the robot has gone to rest.
    pub levels_at_start: Option<[f64; 2]>,
    /// Whether it has rested since it last was in a group.
    pub has_rested: bool,
    /// Whether it cannot get home or to rest, so that the team does not wait for it.
    pub is_cut_off: bool,
    /// The rest places that it has given up on in this round, a bit for each task.
    pub rests_given_up: u64,
    /// Its progress towards its goal.
    pub progress: Progress,
    /// The most energy and HP that one round has cost it, in percent points.
    pub costliest_round: [f64; 2],
}

impl Agent {
    pub(super) fn new() -> Self {
        Self {
            activity: Activity::Home,
            task: None,
            rest_at: TaskId::default(),
            sweep: Vec::new(),
            muster: Vector::ZERO,
            levels_at_start: None,
            has_rested: false,
            is_cut_off: false,
            rests_given_up: 0,
            progress: Progress::default(),
            costliest_round: [0.0; 2],
        }
    }

    /// Whether the robot rests, is on its way to rest, or is on its way home from a rest.
    pub(super) fn is_off_to_rest(&self) -> bool {
        self.activity.is_rest() || self.activity == Activity::Returning && self.has_rested
    }

    /// Sends the robot to its rest place. The cost of this round no longer counts for its costliest round.
    pub(super) fn go_to_rest(&mut self) {
        self.activity = Activity::ToRest;
        self.levels_at_start = None;
    }

    pub(super) fn has_given_up_rest(&self, task: TaskId) -> bool {
        self.rests_given_up & (1 << task.0) != 0
    }

    pub(super) fn has_given_up_all_rests(&self, tasks: u16) -> bool {
        (0..tasks).all(|task| self.has_given_up_rest(TaskId(task)))
    }
}
