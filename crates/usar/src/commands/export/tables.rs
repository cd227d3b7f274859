//! `usar export csv` and `usar export parquet`: the tables of a trial as CSV or as Parquet.

use experiments::files::NewFile;
use exports::{ExportError, parquet};
use recording::Table;

use super::trial::{RecordedArguments, failed};
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
        let (recording, every) = self.recorded.read(registry)?;
        for table in Table::ALL {
            let name = format!("{}.{}", table.name(), if IS_PARQUET { "parquet" } else { "csv" });
            let file = NewFile::new(&self.out, &name)?;
            let failed = |error: ExportError| failed(&self.out.join(&name), &error);
            let file = if IS_PARQUET {
                let rows = table.write_csv(&recording, every, Vec::new()).map_err(failed)?;
                let columns = table.columns(&recording.header.world.needs);
                parquet::from_csv(&*rows, &columns, file).map_err(failed)?
            } else {
                table.write_csv(&recording, every, file).map_err(failed)?
            };
            file.finish()?;
        }
        Ok(writeln!(out, "{}", self.out.display())?)
    }
}
