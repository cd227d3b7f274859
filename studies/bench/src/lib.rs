//! Task allocation to robots with skills, after MRTA-Benchmark and HeteroMRTA: problems, their exact optimum,
//! and schedules by rules and by policies.
//!
//! All robots begin at one location, or each at its own. A task needs a group whose skills together cover
//! what it requires. It starts when the last member of its group has arrived and its predecessors are over.
//! In the end each robot that had a task goes to its end location. The makespan is when the last robot is
//! there.

mod cbba;
mod dispatch;
mod fields;
mod generate;
mod hetero;
mod optimum;
mod problem;
mod read;
mod schedule;

pub use cbba::cbba;
pub use dispatch::{DispatchError, dispatch};
pub use fields::{BadField, BadProblem};
pub use generate::generate;
pub use optimum::{MAX_ROBOTS, MAX_TASKS, optimum};
pub use problem::{Problem, Robot, Skills, Task};
pub use read::{read, write};
pub use schedule::earliest;

/// Hash of the sources of this study.
pub const STUDY: &str = env!("STUDY");

/// The README's example is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
