//! `usar report`: the report of a sweep as one HTML file, and its figures.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use experiments::Failure;
use experiments::sweep::folder::Folder;
use reports::write_report;

/// Write a report: means, comparisons, figures, and where it all comes from
#[derive(Debug, Args)]
#[command(after_help = "\
Writes report.html into the folder, which opens from disk and prints, and plots/: each figure as SVG and its numbers as CSV.

Examples:
  usar report results/paper
  usar report results/energy --case 3      (the third point of the grid)")]
pub(crate) struct Arguments {
    /// Folder of a sweep
    folder: PathBuf,
    /// Number of the case whose figures are drawn, where the sweep has axes
    #[arg(long, default_value_t = 1)]
    case: usize,
}

impl Arguments {
    pub(crate) fn execute(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let mut folder = Folder::read(&self.folder)?;
        let cases = folder.experiment().cases.len();
        if !(1..=cases).contains(&self.case) {
            return Err(Failure::input(format!("--case: must be from 1 to {cases}, found {}", self.case)));
        }
        if folder.results().values().all(|measured| measured.metrics.is_none()) {
            return Err(Failure::input(format!("{}: no trial has given numbers yet", self.folder.display())));
        }
        let path = write_report(&mut folder, self.case - 1)?;
        Ok(writeln!(out, "{}", path.display())?)
    }
}
