//! `usar export parquet`: the tables of a trial as Parquet.

use super::trial::{Form, RecordedArguments, write_tables};
use crate::arguments::ReplaceArgument;
use crate::prelude::*;

/// Write the tables of a trial as Parquet
#[derive(Debug, Args)]
#[command(after_help = "\
The tables are robots, groups, events and decisions: a row for each thing at each time, one header, units in the names.

Examples:
  usar export parquet paper.usrec --every 1 --out tables                one row a second for each robot
  usar export parquet results/paper --policy DIS --seed 3 --out dis")]
pub(crate) struct Arguments {
    #[command(flatten)]
    recorded: RecordedArguments,
    /// File or folder to write
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
    #[command(flatten)]
    replace: ReplaceArgument,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        make_folder(&self.out, self.replace.force)?;
        write_tables(&self.recorded, &self.out, Form::Parquet, registry)?;
        Ok(writeln!(out, "{}", self.out.display())?)
    }
}
