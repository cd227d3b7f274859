#![doc = include_str!("../README.md")]

mod cursor;
mod fields;
pub mod file;
mod layout;
pub mod limits;
mod nearest;
mod path;
mod set;
mod size;
mod syntax;
mod told;
mod unknown;
mod walker;
mod written;

pub use fields::Fields;
pub use layout::formatted;
pub use nearest::nearest;
pub use set::{SetError, set};
pub use size::{TooMuch, check_size};
pub use syntax::{SyntaxError, check_syntax};
pub use told::Misfit;
pub use written::{WriteError, with_values};
