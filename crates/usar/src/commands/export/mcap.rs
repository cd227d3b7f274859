//! `usar export mcap`: a trial as an MCAP log.

use super::trial::{RecordedArguments, failed};
use crate::arguments::ReplaceArgument;
use crate::prelude::*;

/// Write a trial as an MCAP log, for Foxglove, Lichtblick and Rerun
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  usar export mcap paper.usrec --out paper.mcap
  usar export mcap results/paper --policy DIS --seed 3 --out dis.mcap")]
pub(crate) struct Arguments {
    #[command(flatten)]
    recorded: RecordedArguments,
    /// File or folder to write
    #[arg(long, value_name = "FILE.mcap")]
    out: PathBuf,
    #[command(flatten)]
    replace: ReplaceArgument,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let to = Destination::new("--out", &self.out, self.replace.force)?;
        let (recording, every) = self.recorded.read(registry)?;
        let written = exports::mcap::write(&recording, every, to.begin()?);
        written.map_err(|error| failed(&self.out, &error))?.finish()?;
        Ok(writeln!(out, "{}", self.out.display())?)
    }
}
