//! Task allocation to robots with skills, after MRTA-Benchmark: problems, their exact optimum, and schedules
//! by rules and by policies.
//!
//! All robots begin at one location. A task needs a group whose skills together cover what it requires. It
//! starts when the last member of its group has arrived and its predecessors are over. In the end each robot
//! goes to the last location; the makespan is when the last one arrives there.

mod cbba;
mod dispatch;
mod generate;
mod optimum;
mod problem;
mod read;
mod schedule;

pub use cbba::cbba;
pub use dispatch::{DispatchError, dispatch};
pub use generate::generate;
pub use optimum::{MAX_ROBOTS, MAX_TASKS, optimum};
pub use problem::{Problem, Skills, Task};
pub use read::{BadField, BadProblem, read, write};
pub use schedule::earliest;

/// The README's example is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
