//! A physics-backed simulator of mixed robot teams on a rescue mission among debris and radiation.
//!
//! A scenario (RON) becomes a [`scenario::Scenario`], a [`simulation::Simulation`] and at last a [`record::TrialRecord`]:
//!
//! ```no_run
//! use rne_core::{RneOptions, policy_named};
//! use usar_sim::{scenario::Scenario, simulation::Simulation};
//!
//! let (scenario, _text) = Scenario::load("scenarios/paper.ron".as_ref())?;
//! let policy = policy_named("RNE", &RneOptions::default())?;
//! let record = Simulation::new(&scenario, &*policy, 1)?.run(|_time, _events, _world| {});
//! println!("{} rescued", record.rescued());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! One seed, one result, bit for bit: random streams are named by trial, purpose and entity, transcendental functions come from
//! `libm`, and nothing iterates over a hash map or looks at a clock.

pub mod conflict;
pub mod event;
pub mod hash;
pub mod ids;
pub mod invariant;
pub mod layout;
pub mod metrics;
pub mod mission;
pub mod physics;
pub mod planning;
pub mod record;
pub mod scenario;
pub mod seed;
pub mod sensing;
pub mod simulation;
pub mod snapshot;
pub mod stage;
mod tally;
pub mod vitals;
pub mod world;
