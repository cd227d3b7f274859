#![doc = include_str!("../README.md")]

mod cursor;
mod fields;
pub mod file;
pub mod limits;
mod path;
mod set;
mod size;
mod unknown;
mod walker;
mod written;

pub use fields::Fields;
pub use set::{SetError, set};
pub use size::{TooMuch, check_size};
pub use written::{WriteError, with_values};
