//! Rescuees: persons and valuables, in a grid in each task's area.

use std::ops::{Deref, DerefMut, Range};

use parry2d::math::Vector;
use rne_core::TaskId;
use serde::{Deserialize, Serialize};

use crate::ids::{RescueeId, RobotId};

/// The state of a rescuee in its rescue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RescueeState {
    /// At its initial place.
    Waiting,
    /// On board of a robot: secured, not yet rescued.
    OnBoard(RobotId),
    /// Delivered home or to a rest place.
    Rescued,
    /// Not there: it appears later, or disappeared when its task ended.
    Absent,
}

/// A person or valuable to rescue.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rescuee {
    /// Identity.
    #[serde(skip)]
    pub id: RescueeId,
    /// Its task.
    #[serde(skip)]
    pub task: TaskId,
    /// Where it waits.
    #[serde(skip)]
    pub position: Vector,
    /// The state of its rescue.
    pub state: RescueeState,
}

/// All rescuees of a world, by id. Counts mutable accesses, so that checks run only after possible changes.
#[derive(Serialize, Deserialize)]
pub struct Rescuees {
    list: Vec<Rescuee>,
    #[serde(skip)]
    changes: u64,
}

impl Rescuees {
    /// All rescuees at these places. Rescuees in `later` are absent, the others wait.
    pub(super) fn new(places: &[(TaskId, Vector)], later: &[Range<usize>]) -> Self {
        let waiting = |(id, (task, position)): (u32, &(TaskId, Vector))| Rescuee {
            id: RescueeId(id),
            task: *task,
            position: *position,
            state: RescueeState::Waiting,
        };
        let mut list: Vec<Rescuee> = (0..).zip(places).map(waiting).collect();
        for ids in later {
            list[ids.clone()].iter_mut().for_each(|rescuee| rescuee.state = RescueeState::Absent);
        }
        Self { list, changes: 0 }
    }

    /// Restores the fields that a snapshot leaves out: they are fixed.
    pub(super) fn restore(&mut self, places: &[(TaskId, Vector)]) {
        for ((rescuee, id), (task, position)) in self.list.iter_mut().zip(0..).zip(places) {
            (rescuee.id, rescuee.task, rescuee.position) = (RescueeId(id), *task, *position);
        }
    }

    /// Number of mutable accesses to the list.
    #[must_use]
    pub fn changes(&self) -> u64 {
        self.changes
    }
}

impl Deref for Rescuees {
    type Target = Vec<Rescuee>;

    fn deref(&self) -> &Vec<Rescuee> {
        &self.list
    }
}

impl DerefMut for Rescuees {
    fn deref_mut(&mut self) -> &mut Vec<Rescuee> {
        self.changes += 1;
        &mut self.list
    }
}
