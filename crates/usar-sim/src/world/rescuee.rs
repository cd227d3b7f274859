//! Rescuees: persons and valuables, in a grid in each task's area.

use std::ops::{Deref, DerefMut};

use parry2d::math::Vector;
use rne_core::Difficulty;
use serde::{Deserialize, Serialize};

use crate::ids::{RescueeId, RobotId};
use crate::scenario::Scenario;

/// Where a rescuee is in its rescue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RescueeState {
    /// Where it was from the start.
    Waiting,
    /// On board of a robot: secured, not yet rescued.
    OnBoard(RobotId),
    /// Delivered home or to a rest place.
    Rescued,
}

/// A person or valuable to rescue.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rescuee {
    /// Identity.
    pub id: RescueeId,
    /// The task that it belongs to.
    pub task: Difficulty,
    /// Where it waits.
    pub position: Vector,
    /// Where it is in its rescue.
    pub state: RescueeState,
    /// The robot that is on its way to it or loading it.
    pub claimed_by: Option<RobotId>,
}

/// All rescuees of a world, by id. Counts how often somebody may have changed one, so that who checks them looks only then.
#[derive(Serialize, Deserialize)]
pub struct Rescuees {
    list: Vec<Rescuee>,
    #[serde(skip)]
    changes: u64,
}

impl Rescuees {
    pub(super) fn new(list: Vec<Rescuee>) -> Self {
        Self { list, changes: 0 }
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

/// All rescuees, waiting; those of the hard task first.
#[must_use]
pub fn rescuee_positions(scenario: &Scenario) -> Vec<Rescuee> {
    let mut rescuees = Vec::new();
    for task in Difficulty::ALL {
        let area = scenario.tasks.of(task);
        let along = |i: u32, count: u32, center: f64, size: f64| {
            if count < 2 { center } else { center - size / 2.0 + size * f64::from(i) / f64::from(count - 1) }
        };
        for row in 0..area.grid[1] {
            for column in 0..area.grid[0] {
                let x = along(column, area.grid[0], area.center[0], area.size_m[0]);
                let y = along(row, area.grid[1], area.center[1], area.size_m[1]);
                rescuees.push(Rescuee {
                    id: RescueeId(rescuees.len() as u32),
                    task,
                    position: Vector::new(x as f32, y as f32),
                    state: RescueeState::Waiting,
                    claimed_by: None,
                });
            }
        }
    }
    rescuees
}
