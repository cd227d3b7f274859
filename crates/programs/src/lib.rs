#![doc = include_str!("../README.md")]

mod consent;
mod driver;
mod error;
mod files;
mod guard;
mod living;
mod options;
mod process;
mod protocol;
pub mod questions;
pub mod templates;
mod unique;

pub use consent::{Consent, Unknown};
pub use driver::{Launch, add_names, add_to};
pub use guard::guard;
pub use living::end_all;
pub use options::quoted;
