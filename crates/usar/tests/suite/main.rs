//! The program `usar`, run as by a user. All tests are one binary, since each binary takes long to link.

/// The program.
pub const PROGRAM: &str = env!("CARGO_BIN_EXE_usar");

mod forged;
mod place;
mod support;

mod bent;
mod cluster;
mod commands;
mod compared;
mod damaged;
mod decided;
mod distributions;
mod drawn;
mod empty;
mod expected;
mod explored;
mod exported;
mod files;
mod flipped;
mod grids;
mod guarded;
mod hostile;
mod lies;
mod programs;
mod reported;
mod resumed;
mod same_bytes;
mod shell;
mod strangers;
mod tabled;
mod taught;
mod teams;
mod viewed;
