//! A robot as it is known by what it reported of itself.

use std::ops::Deref;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::model::RobotModel;
use crate::robot::RobotState;

/// A robot as it is known: the state that it reported last, and when. It dereferences to that state.
#[derive(Debug, Serialize, Deserialize)]
pub struct KnownRobot {
    state: RobotState,
    /// The step as of which it reported.
    reported_step: u64,
}

impl Deref for KnownRobot {
    type Target = RobotState;

    fn deref(&self) -> &RobotState {
        &self.state
    }
}

impl KnownRobot {
    /// A robot of which nothing is known but its fixed properties: it is at home, as it starts.
    pub fn new(model: &Arc<RobotModel>) -> Self {
        Self { state: RobotState::new(model), reported_step: 0 }
    }

    /// Its fixed properties, which a snapshot leaves out.
    pub fn restore(&mut self, model: &Arc<RobotModel>) {
        self.state.model = Arc::clone(model);
    }

    /// It reports its state as of a step.
    pub(super) fn hear(&mut self, state: &RobotState, at_step: u64) {
        self.state.be_as(state);
        self.reported_step = at_step;
    }

    /// The base hands it as many resources as it can hold. Returns whether it lacked some.
    pub(crate) fn restock(&mut self) -> bool {
        let full = self.spec.resources;
        std::mem::replace(&mut self.state.resources, full) < full
    }

    /// What counts in the hash chain.
    pub(super) fn to_hash(team: &[Self]) -> impl Serialize + '_ {
        let states: Vec<&RobotState> = team.iter().map(|robot| &robot.state).collect();
        let reported_step: Vec<u64> = team.iter().map(|robot| robot.reported_step).collect();
        (states, reported_step)
    }
}
