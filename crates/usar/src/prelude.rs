//! What most verbs need.

pub(crate) use std::io::Write;
pub(crate) use std::path::{Path, PathBuf};

pub(crate) use clap::Args;
pub(crate) use experiments::{Failure, refuse};
pub(crate) use rne_core::Registry;

pub(crate) use crate::output::{Destination, csv_of, make_folder, print_json, print_table};
pub(crate) use crate::printable::counted;
pub(crate) use crate::running::{STOP, is_stopped, session_of, stop_on_signals, tell};
