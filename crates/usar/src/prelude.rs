//! What most verbs need.

pub use std::io::Write;
pub use std::path::{Path, PathBuf};

pub use clap::Args;
pub use experiments::{Failure, refuse};
pub use tables::{Entry, Table, labelled, or_dash, right, right_or_dash, valued};
pub use teaming::Registry;

pub use crate::output::{Destination, make_folder};
pub use crate::printable::counted;
pub use crate::report::Report;
pub use crate::running::{STOP, is_stopped, session_of, stop_on_signals, tell};
