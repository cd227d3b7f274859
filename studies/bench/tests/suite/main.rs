//! The study as a user meets it, and its parts.

#[path = "../../../../crates/usar/tests/suite/support.rs"]
#[expect(dead_code, reason = "shared with the tests of the laboratory")]
mod support;

mod bad_problems;
mod brute_force;
mod depots;
mod gaps;
mod published;

/// The program of the study. That of the laboratory, which starts it, stands beside it: testing the workspace
/// builds both.
pub const PROGRAM: &str = env!("CARGO_BIN_EXE_usar-bench");
