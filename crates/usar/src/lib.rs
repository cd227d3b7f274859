//! The command `usar` as a library: the `main` of a program that adds policies of its own is [`main_with`].

mod cli;
mod commands;
mod printable;
mod recordings;
mod running;

pub use cli::{main, main_with};

/// The program of the page about policies compiles.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/policies.md")]
struct Policies;
