//! Which moments of the timeline have happened.

use serde::{Deserialize, Serialize};

use crate::model::{Action, Model};

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

    /// Whether an action has still to happen before the end of the trial.
    pub(super) fn is_to_come(&self, model: &Model) -> bool {
        let mut all = self.done.iter().zip(&model.timeline);
        all.any(|(is_done, due)| !is_done && due.step < model.steps)
    }

    /// Whether an action that opens a way has still to happen, or happened after a step, so that a robot may
    /// not have seen it yet.
    pub(super) fn opens_after(&self, step: u64, model: &Model) -> bool {
        let opens = |action: &Action| matches!(action, Action::Open(_) | Action::Die(_));
        let mut all = self.done.iter().zip(&model.timeline);
        all.any(|(is_done, due)| {
            opens(&due.action) && due.step < model.steps && (!is_done || due.step > step)
        })
    }

    pub(super) fn is_empty(&self) -> bool {
        self.done.is_empty()
    }
}
