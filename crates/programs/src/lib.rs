#![doc = include_str!("../README.md")]

mod driver;
mod error;
mod files;
mod living;
mod options;
mod process;
mod protocol;
pub mod questions;
pub mod templates;

pub use driver::kind;
pub use living::end_all;
