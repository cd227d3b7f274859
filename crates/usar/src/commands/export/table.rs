//! `usar export table`: prints everything that a sweep measured as one long table.

use experiments::sweep::folder::Folder;
use experiments::sweep::{tidy_columns, tidy_rows};

use crate::arguments::ReplaceArgument;
use crate::input::read_sweep;
use crate::prelude::*;

/// Print everything that a sweep measured as one long table: a row for each value
#[derive(Debug, Args)]
#[command(after_help = "\
Columns: case, the sweep's axes, policy, trial, seed, round, task, metric, value. Values of a whole trial \
have no round, those of all tasks together no task. columns.md in the sweep's folder says what each metric \
means.

Examples:
  usar export table results/paper | head
  usar export table results/paper --out tidy.csv
  python3 -c \"import pandas; print(pandas.read_csv('tidy.csv').query('metric \
  == \\\"rescuees\\\"').groupby('policy').value.describe())\"")]
pub(crate) struct Arguments {
    /// Folder of a sweep
    folder: PathBuf,
    /// File or folder to write
    #[arg(long, value_name = "CSV")]
    out: Option<PathBuf>,
    #[command(flatten)]
    replace: ReplaceArgument,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let mut folder = read_sweep(&self.folder, registry)?;
        let Some(path) = &self.out else { return print(&mut folder, out) };
        let mut file = Destination::new("--out", path, self.replace.force)?.begin()?;
        print(&mut folder, &mut file)?;
        file.finish().map(drop)
    }
}

fn print(folder: &mut Folder, out: &mut dyn Write) -> Result<(), Failure> {
    let mut table = csv::Writer::from_writer(out);
    let trouble = |error: csv::Error| match error.into_kind() {
        csv::ErrorKind::Io(error) => Failure::from(error),
        other => Failure::run(format!("{other:?}")),
    };
    table.write_record(tidy_columns(folder)).map_err(trouble)?;
    tidy_rows(folder, |row| table.write_record(row).map_err(trouble))?;
    table.flush()?;
    Ok(())
}
