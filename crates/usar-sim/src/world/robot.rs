//! The robots of the world, as they really are.

use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::model::RobotModel;
use crate::robot::RobotState;

/// A robot as it really is. Only sensors and the mechanics of the world see it. It dereferences to its state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Robot(RobotState);

impl Robot {
    /// A robot at home, without motion, with its initial levels.
    pub(super) fn new(model: &Arc<RobotModel>) -> Self {
        Self(RobotState::new(model))
    }
}

impl Deref for Robot {
    type Target = RobotState;

    fn deref(&self) -> &RobotState {
        &self.0
    }
}

impl DerefMut for Robot {
    fn deref_mut(&mut self) -> &mut RobotState {
        &mut self.0
    }
}
