//! The sessions of one worker: opened at the first trial of each policy, and kept over trials.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use teaming::{Basis, MadePolicy, PolicyError, Session};

/// The open sessions of a worker, by the number of their policy in the sweep.
#[derive(Default)]
pub struct Sessions {
    open: BTreeMap<usize, Box<dyn Session>>,
}

/// An open session, and what its answers follow from.
pub struct Player<'s> {
    /// The session.
    pub session: &'s mut dyn Session,
    /// What its answers follow from.
    pub basis: Basis,
}

impl Sessions {
    /// The session of a policy, by its number.
    ///
    /// # Errors
    /// It cannot be opened.
    pub fn of(&mut self, number: usize, policy: &MadePolicy) -> Result<Player<'_>, PolicyError> {
        let session = match self.open.entry(number) {
            Entry::Occupied(open) => open.into_mut(),
            Entry::Vacant(place) => place.insert(policy.open()?),
        };
        Ok(Player { session: &mut **session, basis: policy.it.basis() })
    }

    /// Ends the session of a policy, after a trial that left it in an unknown state.
    pub fn close(&mut self, policy: usize) {
        self.open.remove(&policy);
    }
}
