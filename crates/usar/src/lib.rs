//! The command `usar` as a library.
//!
//! A program that adds its own policies calls [`main_with`] as its `main`. The program of a study calls
//! [`main_of`] with a [`CommandLine`] of its own, made of [`arguments`] and [`prelude`]: `usar NAME` starts
//! `usar-NAME`.

pub mod arguments;
mod bad_value;
mod builds;
mod cli;
mod command_line;
mod commands;
pub mod input;
mod library;
pub mod output;
#[cfg(feature = "exports")]
mod parquets;
pub mod prelude;
mod printable;
mod recordings;
pub mod report;
mod retired;
mod running;
mod studies;

pub use bad_value::BadValue;
pub use cli::{main, main_of, main_with, run};
pub use command_line::CommandLine;
pub use commands::command;
pub use library::{carried, carry, path as scenario_path};

/// The program on the page about policies compiles.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/policies.md")]
struct Policies;

/// So does the one on the front page.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct FrontPage;
