//! A physics-backed simulator of mixed robot teams on a rescue mission among debris and radiation.
//!
//! A scenario file (RON) becomes a [`scenario::Scenario`]. A scenario and a seed become a [`model::Model`]. A
//! [`simulation::Simulation`] changes the state step by step, asks how the team is to be grouped, and ends
//! with a [`record::TrialRecord`]:
//!
//! ```no_run
//! use scenario::Scenario;
//! use usar_sim::simulation::Simulation;
//!
//! let (scenario, _text) = Scenario::load("scenarios/paper.ron".as_ref())?;
//! let mut rne = policies::standard().open("RNE")?;
//! let record = Simulation::new(&scenario, 1)?.run(&mut *rne, |_time, _events, _world| {});
//! println!("{} rescued", record.rescued());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Whoever decides, in the crate [`autonomy`], knows robots by what they reported. A robot of the world is
//! another type:
//!
//! ```compile_fail,E0308
//! fn peek(world: &usar_sim::world::World) -> &[usar_sim::belief::KnownRobot] {
//!     &world.robots
//! }
//! ```
//!
//! One seed gives one result, bit for bit. Random streams are identified by trial, purpose and entity;
//! transcendental functions come from `libm`; and nothing iterates over a hash map or reads a clock.

/// Number of the program's bits. Whoever changes what comes out of a trial raises it: trials of one number
/// are the same for the same scenario, policy and seed, and results that name another number tell of an
/// older program. A test holds it against golden outcomes.
pub const BITS: u32 = 12;

/// Number of the way in which the state is hashed. Whoever changes hashes and nothing that comes out of a
/// trial raises it instead.
pub const HASH_FORMAT: u32 = 3;

pub use autonomy::{
    belief, conflict, event, executor, hash, ids, intent, mission, model, navigation, planning, report,
    robot, telemetry, vitals,
};

pub mod fit;
pub mod invariant;
pub mod metrics;
pub mod physics;
mod quiet;
pub mod record;
pub mod sensors;
pub mod simulation;
pub mod snapshot;
pub mod stage;
mod tally;
pub mod world;

/// The programs in the README compile and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
