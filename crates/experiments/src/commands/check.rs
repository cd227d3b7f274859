//! `usar check`: validates scenarios without running them.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use usar_sim::layout::Layout;

use super::load;
use crate::failure::Failure;

/// Validate scenarios without running them
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  usar check scenarios/*.ron")]
pub(crate) struct Arguments {
    /// Scenario files (RON)
    #[arg(required = true)]
    files: Vec<PathBuf>,
}

impl Arguments {
    pub(crate) fn execute(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let mut problems = Vec::new();
        for file in &self.files {
            let checked = load(file).and_then(|(scenario, _)| {
                Layout::sample(&scenario, scenario.sweep.first_seed)
                    .map_err(|error| Failure::input(format!("{}: {error}", file.display())))
            });
            match checked {
                Ok(_) => writeln!(out, "{}: ok", file.display())?,
                Err(failure) => problems.push(failure.to_string()),
            }
        }
        if problems.is_empty() { Ok(()) } else { Err(Failure::Input(problems.join("\n"))) }
    }
}
