//! Recordings of trials: the positions, actions and reasons of all robots, ten times a second, in a small
//! file.
//!
//! A [`Recorder`] listens to a simulation and writes the file; [`record()`] runs a whole trial with one.
//! [`Recording::read`] reads the file, even if it is truncated, and [`Recording::frame`] gives the state at
//! any of its frames. The format is documented in `docs/recordings.md`. It has a magic number and chunks,
//! each with checksums. Positions are integers in millimetres, stored as differences from frame to frame.
//! Every few seconds the whole state is stored.
//!
//! [`Table`] writes the time series of robots and groups, events and decisions as CSV.
//!
//! Recording does not influence the trial: its result is the same with and without it.
//!
//! ```no_run
//! use recording::{Options, Recording, record};
//! use scenario::Scenario;
//! use usar_sim::simulation::Simulation;
//!
//! let (scenario, _text) = Scenario::load("scenarios/paper.ron".as_ref())?;
//! let registry = policies::standard();
//! let (mut policy, measure) = (registry.open("RNE")?, registry.measure("RNE")?);
//! let simulation = Simulation::new(&scenario, 1)?;
//! let mut bytes = Vec::new();
//! record(simulation, &mut *policy, &Options::new("RNE", Some(measure)), &mut bytes)?;
//! let recording = Recording::read(&bytes)?;
//! let halfway = recording.frame(recording.frames() / 2)?;
//! println!("robot 0 is at {:?} mm", halfway.robots[0].motion.position_mm);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod chunk;
mod error;
mod fits;
mod frame;
mod header;
mod needs;
mod numbers;
mod reader;
mod rows;
mod segment;
mod table;
mod trust;
mod words;
mod writer;

pub use error::ReadError;
pub use frame::{Frame, GroupFrame, Motion, MovedDebris, RescueeFrame, RobotFrame, RobotState, Route};
pub use header::{Codes, Header, RobotPlace, ScenarioText, TaskPlace, VERSION, World};
pub use reader::{Recording, TimedDecision};
pub use table::Table;
pub use trust::Trust;
pub use words::{Names, ToldEvent, told};
pub use writer::{DEFAULT_FPS, Options, Recorder, record};

/// The programs in the README compile and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
