//! Which moments of the timeline have happened.

use serde::{Deserialize, Serialize};

use crate::model::Model;

/// For each event of the timeline, in the order of their steps, whether it has happened.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct Moments {
    pub(super) done: Vec<bool>,
}

impl Moments {
    /// The timeline of a model, of which nothing has happened yet.
    pub(super) fn of(model: &Model) -> Self {
        Self { done: vec![false; model.timeline.len()] }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.done.is_empty()
    }
}
