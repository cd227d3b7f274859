//! `usar check`: validates scenarios and sweep files without running them.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use experiments::Failure;
use experiments::experiment::{Experiment, Overrides};

/// Validate scenarios and sweep files without running them
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  usar check scenarios/*.ron scenarios/sweeps/*.ron")]
pub(crate) struct Arguments {
    /// Scenario or sweep files (RON)
    #[arg(required = true)]
    files: Vec<PathBuf>,
}

impl Arguments {
    pub(crate) fn execute(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let mut problems = Vec::new();
        for file in &self.files {
            let checked = Experiment::load(file, &Overrides::default())
                .and_then(|experiment| experiment.with_trials(1)?.check_start(file));
            match checked {
                Ok(()) => writeln!(out, "{}: ok", file.display())?,
                Err(failure) => problems.push(failure.to_string()),
            }
        }
        if problems.is_empty() { Ok(()) } else { Err(Failure::Input(problems.join("\n"))) }
    }
}
