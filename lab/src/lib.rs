//! The laboratory of a web page: scenarios are checked, trials are run, and pairs of trials are compared,
//! by the same code as in the command. Built for WebAssembly, it imports nothing: no file, no clock, no
//! random source.
//!
//! [`door`] has the exports. Each takes JSON and replies with JSON; the modules beside it answer.

mod check;
mod compare;
mod door;
mod texts;
mod trial;

use std::fmt::Display;

use serde::Serialize;

/// A failure, as the page shows it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Failure {
    /// What is wrong, in a sentence.
    error: String,
}

impl Failure {
    fn of(error: impl Display) -> Self {
        Self { error: error.to_string() }
    }
}

/// A policy that the page offers.
#[derive(Serialize)]
struct Offer {
    name: String,
    about: String,
    /// Its options with their defaults in RON; empty where there are none.
    options: String,
}

/// The policies of the program.
fn policies() -> Vec<Offer> {
    let registry = ::policies::standard();
    let offer = |kind: &teaming::PolicyKind| Offer {
        name: kind.name.clone(),
        about: kind.about.clone(),
        options: kind.defaults.clone(),
    };
    registry.kinds().iter().map(offer).collect()
}
