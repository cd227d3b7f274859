//! The command `usar` as a library. A program that adds its own policies calls [`main_with`] as its `main`.

mod arguments;
mod bad_value;
mod cli;
mod commands;
mod input;
mod library;
mod output;
mod parquets;
mod prelude;
mod printable;
mod recordings;
mod running;

pub use cli::{main, main_with, run};
pub use library::{carried, carry, path as scenario_path};

/// The program on the page about policies compiles.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/policies.md")]
struct Policies;

/// So does the one on the front page.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct FrontPage;
