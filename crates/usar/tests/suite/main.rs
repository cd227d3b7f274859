//! The program `usar`, run as by a user. All tests are one binary, since each binary takes long to link.

mod place;
mod support;

mod benched;
mod bent;
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
mod lies;
mod programs;
mod reported;
mod resumed;
mod same_bytes;
mod shell;
mod studied;
mod tabled;
mod taught;
mod teams;
mod viewed;
