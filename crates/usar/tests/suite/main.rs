//! The program `usar`, run as by a user. All tests are one binary, since each binary takes long to link.

/// The program.
pub const PROGRAM: &str = env!("CARGO_BIN_EXE_usar");

mod altered_results;
mod place;
mod support;

mod cluster;
mod commands;
mod comparisons;
mod damaged_folders;
mod deceit;
mod decisions;
mod distributions;
mod exhausting_files;
mod expectations;
mod exports;
mod flipped_bits;
mod foreign_files;
mod implausible_values;
mod interrupted_sweeps;
mod pictures;
mod programs;
mod recordings;
mod reports;
mod same_bytes;
mod scenario_files;
mod search_and_sensitivity;
mod shell;
mod small_results;
mod sweep_files;
mod tables;
mod trust_tables;
mod tutorials;
mod untrusted_files;
