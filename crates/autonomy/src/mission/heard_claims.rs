//! What a robot knows of claims that go by radio.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use crate::ids::{RescueeId, RobotId};
use crate::report::Claim;

/// What a robot knows of claims.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct HeardClaims {
    /// The step in which the round began.
    pub(super) since_step: u64,
    /// What each mate told last.
    pub(super) mates: BTreeMap<RobotId, Heard>,
    /// Rescuees that were given up, as far as the robot knows.
    pub(super) given_up: BTreeSet<RescueeId>,
    /// Those of which it has not told its mates.
    pub(super) untold: Vec<RescueeId>,
    /// The last claim that it told, and the step in which it did.
    pub(super) told: Option<(Claim, u64)>,
    /// Whether it is to tell its claim again, because a mate does not know of it.
    pub(super) tells_again: bool,
}

/// What a mate told of its claim.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Heard {
    /// The claim; none if the mate claims nothing.
    pub(super) claim: Option<Claim>,
    /// The step in which it was told.
    pub(super) said_at: u64,
    /// The step in which it was heard.
    pub(super) heard_at: u64,
}

impl HeardClaims {
    /// Nothing, in a round that begins in this step.
    pub(super) fn since(since_step: u64) -> Self {
        Self { since_step, ..Self::default() }
    }

    /// Whether a rescuee is free, as far as the robot knows. Claims of the same step still compete.
    pub(super) fn is_free(&self, rescuee: RescueeId, step: u64) -> bool {
        let is_taken = |claim: &Claim| claim.rescuee == rescuee && claim.since_step < step;
        !self.given_up.contains(&rescuee) && !self.claims().any(|(_, claim)| is_taken(claim))
    }

    /// The claims of mates.
    pub(super) fn claims(&self) -> impl Iterator<Item = (RobotId, &Claim)> {
        self.mates.iter().filter_map(|(by, heard)| Some((*by, heard.claim.as_ref()?)))
    }

    /// Gives a rescuee up, and is to tell its mates.
    pub(super) fn give_up(&mut self, rescuee: RescueeId) {
        if self.given_up.insert(rescuee) {
            self.untold.push(rescuee);
        }
    }
}
