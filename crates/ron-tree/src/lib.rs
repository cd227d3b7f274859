#![doc = include_str!("../README.md")]

mod de;
mod edit;
pub mod file;
mod layout;
pub mod limits;
mod malformed;
mod named;
mod nearest;
mod node;
mod parse;
mod path;
mod plain;
mod print;
mod problem;
mod read;
mod ser;
#[cfg(test)]
mod tests;

pub use edit::{edited, value_of};
pub use layout::formatted;
pub use malformed::Malformed;
pub use nearest::nearest;
pub use node::{Node, Place, Value};
pub use plain::{is_unseen, visible, without_types};
pub use problem::{MUST_BE_GIVEN, NO_FIELD, Problem};
