//! The state of a trial in memory, from which any number of trials can resume.

use std::sync::Arc;

use super::setup::Setup;
use super::{Simulation, State};

/// The state of a trial at one moment. Trials that resume from it share the setup and all random streams, so
/// differences between them follow from their decisions alone.
///
/// A checkpoint stays in this process; [`Simulation::snapshot`] writes the state for others.
#[derive(Clone)]
pub struct Checkpoint {
    setup: Arc<Setup>,
    state: Vec<u8>,
}

impl Simulation {
    /// The present state, also while a question waits for its answer.
    ///
    /// # Panics
    /// Never: the state is of types that postcard can write to memory.
    pub fn checkpoint(&self) -> Checkpoint {
        let state = postcard::to_stdvec(&self.state).expect("the state can be written to memory");
        Checkpoint { setup: Arc::clone(&self.setup), state }
    }
}

impl Checkpoint {
    /// A trial that resumes from here. It has the same result bit for bit if its decisions are the same.
    /// Invariants are not checked until [`Simulation::checked`] is called.
    ///
    /// # Panics
    /// Never: the bytes are those that [`Simulation::checkpoint`] wrote.
    pub fn resume(&self) -> Simulation {
        let state: State = postcard::from_bytes(&self.state).expect("the state was written by this program");
        Simulation::from_state(Arc::clone(&self.setup), state)
    }

    /// Bytes of the state.
    pub fn size(&self) -> usize {
        self.state.len()
    }
}
