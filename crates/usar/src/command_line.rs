//! What a command line is, whose program ever.

use clap::{CommandFactory, FromArgMatches};

use crate::prelude::*;

/// A command line: that of `usar` itself, or that of the program of a study.
pub trait CommandLine: CommandFactory + FromArgMatches {
    /// Whether programs that a file names as policies are started, and allowed from now on.
    fn runs_programs(&self) -> bool;

    /// Whether the command asks policies. Any other only reads: to it, programs are names that stand for
    /// themselves.
    fn asks_policies(&self) -> bool {
        true
    }

    /// Executes the command, and returns what it tells.
    ///
    /// # Errors
    /// What the process ends with, as [`main`](crate::main) says.
    fn execute(&self, registry: &Registry) -> Result<Report, Failure>;
}
