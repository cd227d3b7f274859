#![doc = include_str!("../README.md")]

mod cursor;
mod fields;
pub mod file;
mod path;
mod set;
mod unknown;
mod walker;
mod written;

pub use fields::Fields;
pub use set::{SetError, set};
pub use written::{WriteError, with_values};
