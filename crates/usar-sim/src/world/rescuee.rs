//! Rescuees: persons and valuables, in a grid in each task's area.

use std::ops::{Deref, DerefMut, Range};

use parry2d::math::Vector;
use rne_core::TaskId;
use serde::{Deserialize, Serialize};

use crate::ids::{RescueeId, RobotId};

/// Where a rescuee is in its rescue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RescueeState {
    /// Where it was from the start.
    Waiting,
    /// On board of a robot: secured, not yet rescued.
    OnBoard(RobotId),
    /// Delivered home or to a rest place.
    Rescued,
    /// Not there: it appears later, or is gone with its task.
    Absent,
}

/// A person or valuable to rescue.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rescuee {
    /// Identity.
    #[serde(skip)]
    pub id: RescueeId,
    /// The task that it belongs to.
    #[serde(skip)]
    pub task: TaskId,
    /// Where it waits.
    #[serde(skip)]
    pub position: Vector,
    /// Where it is in its rescue.
    pub state: RescueeState,
    /// The robot that is on its way to it or loading it.
    pub claimed_by: Option<RobotId>,
}

/// All rescuees of a world, by id. Counts how often somebody may have changed one, so that checks look only then.
#[derive(Serialize, Deserialize)]
pub struct Rescuees {
    list: Vec<Rescuee>,
    #[serde(skip)]
    changes: u64,
}

impl Rescuees {
    /// All of them, waiting at these places.
    pub(super) fn new(places: &[(TaskId, Vector)], later: &[Range<usize>]) -> Self {
        let waiting = |(id, (task, position)): (u32, &(TaskId, Vector))| Rescuee {
            id: RescueeId(id),
            task: *task,
            position: *position,
            state: RescueeState::Waiting,
            claimed_by: None,
        };
        let mut list: Vec<Rescuee> = (0..).zip(places).map(waiting).collect();
        for ids in later {
            list[ids.clone()].iter_mut().for_each(|rescuee| rescuee.state = RescueeState::Absent);
        }
        Self { list, changes: 0 }
    }

    /// Makes anew what a snapshot leaves out because it is fixed.
    pub(super) fn restore(&mut self, places: &[(TaskId, Vector)]) {
        for ((rescuee, id), (task, position)) in self.list.iter_mut().zip(0..).zip(places) {
            (rescuee.id, rescuee.task, rescuee.position) = (RescueeId(id), *task, *position);
        }
    }

    /// How often the list was lent to be changed.
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
