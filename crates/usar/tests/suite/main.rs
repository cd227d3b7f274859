//! The program `usar`, run as a user runs it. One binary, since each takes long to link.

mod place;
mod support;

mod calibrated;
mod cluster;
mod commands;
mod compared;
mod damaged;
mod decided;
mod distributions;
mod drawn;
mod expected;
mod explored;
mod exported;
mod files;
mod grids;
mod guarded;
mod hostile;
mod reported;
mod resumed;
mod same_bytes;
mod shell;
mod studied;
mod tabled;
mod taught;
mod viewed;
