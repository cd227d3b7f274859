//! Rescuees: persons and valuables, in a grid in each task's area.

use std::ops::{Deref, DerefMut};

use serde::{Deserialize, Serialize};

use crate::hash::part_of_many;
use crate::ids::RobotId;
use crate::model::RescueeModel;

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

impl RescueeState {
    fn word(self) -> u32 {
        match self {
            Self::Waiting => 0,
            Self::Rescued => 1,
            Self::Absent => 2,
            Self::OnBoard(robot) => 3 + robot.0,
        }
    }
}

/// A person or valuable to rescue. It dereferences to its fixed properties, the [`RescueeModel`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rescuee {
    #[serde(skip)]
    pub(crate) model: RescueeModel,
    /// The state of its rescue.
    pub state: RescueeState,
}

impl Deref for Rescuee {
    type Target = RescueeModel;

    fn deref(&self) -> &RescueeModel {
        &self.model
    }
}

/// All rescuees of a world, by id. Counts mutable accesses, so that checks run only after possible changes.
#[derive(Serialize, Deserialize)]
pub struct Rescuees {
    list: Vec<Rescuee>,
    #[serde(skip)]
    changes: u64,
}

impl Rescuees {
    /// All rescuees: those that are there at the start wait.
    pub(super) fn new(models: &[RescueeModel]) -> Self {
        let state =
            |model: &RescueeModel| if model.is_later { RescueeState::Absent } else { RescueeState::Waiting };
        let rescuee = |model: &RescueeModel| Rescuee { model: *model, state: state(model) };
        Self { list: models.iter().map(rescuee).collect(), changes: 0 }
    }

    /// A hash of the states of all rescuees.
    pub(crate) fn digest(&self) -> u128 {
        part_of_many(self.list.iter().map(|rescuee| [rescuee.state.word()]))
    }

    /// Number of mutable accesses to the list.
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
