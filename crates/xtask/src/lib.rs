//! Code that the project's tasks share with its tests and benchmarks: worlds to run, teams to group, and
//! checks. The tests run the checks on few cases and the tasks on many.

#![expect(
    clippy::missing_panics_doc,
    reason = "these are parts of tests: they panic where something is not as it must be"
)]

pub mod density;
pub mod docs;
pub mod golden;
pub mod journeys;
pub mod limits;
pub mod manual;
pub mod movement;
pub mod navigation;
pub mod pages;
pub mod quiet;
pub mod random;
pub mod reference;
pub mod reference_pages;
pub mod results;
pub mod rooms;
pub mod team;
pub mod verdicts;
pub mod weight;
pub mod worlds;
