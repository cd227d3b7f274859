//! Protocols as drivers.

use std::sync::Arc;

use crate::decision::Decision;
use crate::error::PolicyError;
use crate::protocol::{Act, Protocol, Turn};
use crate::session::{Asked, Driver, Session};

/// A protocol as a driver of turns.
pub struct Talk<P>(Arc<P>);

impl<P: Protocol + 'static> Talk<P> {
    /// The driver of a protocol.
    pub fn shared(protocol: P) -> Arc<dyn Driver> {
        Arc::new(Self(Arc::new(protocol)))
    }
}

impl<P: Protocol + 'static> Driver for Talk<P> {
    fn open(&self) -> Result<Box<dyn Session>, PolicyError> {
        Ok(Box::new(Self(Arc::clone(&self.0))))
    }
}

impl<P: Protocol> Session for Talk<P> {
    fn decide(&mut self, _: &Asked<'_>) -> Result<Decision, PolicyError> {
        Err(PolicyError::NoRule)
    }

    fn act(&mut self, turns: &[Turn], _: &Asked<'_>) -> Result<Vec<Act>, PolicyError> {
        turns.iter().map(|turn| self.0.turn(turn)).collect()
    }
}
