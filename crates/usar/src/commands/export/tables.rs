//! `usar export csv` and `usar export parquet`: the tables of a trial as CSV or as Parquet.

use super::trial::{Form, RecordedArguments, write_tables};
use crate::arguments::ReplaceArgument;
use crate::prelude::*;

/// What the help says of the verb with this name.
pub(super) fn help(verb: &str) -> String {
    format!(
        "\
The tables are robots, groups, events and decisions: a row for each thing at each time, one header, units in the names.

Examples:
  usar export {verb} paper.usrec --every 1 --out tables                one row a second for each robot
  usar export {verb} results/paper --policy DIS --seed 3 --out dis"
    )
}

#[derive(Debug, Args)]
pub(crate) struct Arguments<const IS_PARQUET: bool> {
    #[command(flatten)]
    recorded: RecordedArguments,
    /// File or folder to write
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
    #[command(flatten)]
    replace: ReplaceArgument,
}

impl<const IS_PARQUET: bool> Arguments<IS_PARQUET> {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        make_folder(&self.out, self.replace.force)?;
        let form = if IS_PARQUET { Form::Parquet } else { Form::Csv };
        write_tables(&self.recorded, &self.out, form, registry)?;
        Ok(writeln!(out, "{}", self.out.display())?)
    }
}
