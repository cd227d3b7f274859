//! `usar export`: writes a trial for other programs, as an MCAP log and as tables in CSV or Parquet.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{ArgGroup, Args};
use experiments::Failure;
use experiments::files::NewFile;
use exports::tables::Table;
use exports::{ExportError, mcap, parquet};
use recording::Recording;
use rne_core::Registry;

use super::output;
use super::trials::Asked;

/// Export a trial for other programs: MCAP logs, tables in CSV or Parquet
#[derive(Debug, Args)]
#[command(
    group(ArgGroup::new("what").args(["mcap", "csv", "parquet"]).multiple(true).required(true)),
    after_help = "\
FILE is a recording (`usar run --record`), a scenario, which is simulated first, or the folder of a sweep, \
whose trial is taken from its recordings or simulated again.

An MCAP log is for Foxglove, Lichtblick and Rerun. The tables are robots, groups, events and decisions: a \
row for each thing at each time, one header, units in the names.

Examples:
  usar export paper.usrec --mcap paper.mcap
  usar export paper.usrec --csv tables --every 1                one row a second for each robot
  usar export results/paper --policy DIS --seed 3 --parquet dis
  usar export scenarios/paper.ron --csv tables --parquet tables"
)]
pub(crate) struct Arguments {
    /// Recording, scenario or folder of a sweep
    file: PathBuf,
    #[command(flatten)]
    asked: Asked,
    /// Write an MCAP log; the file must not exist yet
    #[arg(long, value_name = "FILE.mcap")]
    mcap: Option<PathBuf>,
    /// Folder for the tables as CSV
    #[arg(long, value_name = "FOLDER")]
    csv: Option<PathBuf>,
    /// Folder for the tables as Parquet
    #[arg(long, value_name = "FOLDER")]
    parquet: Option<PathBuf>,
    /// Seconds of simulated time from one state to the next [default: every frame of the recording]
    #[arg(long, value_name = "SECONDS", value_parser = super::seconds)]
    every: Option<f64>,
    /// Replace files that are there already
    #[arg(long)]
    force: bool,
}

fn failed(path: &Path, error: &ExportError) -> Failure {
    match error {
        ExportError::Recording(_) => Failure::input(error),
        _ => Failure::storage(format!("{}: {error}", path.display())),
    }
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let log = self.mcap.as_deref().map(|path| output::place("--mcap", path, self.force)).transpose()?;
        let folders = [("--csv", &self.csv), ("--parquet", &self.parquet)];
        let folders = folders.iter().filter_map(|(flag, path)| Some((*flag, path.as_deref()?)));
        folders.clone().try_for_each(|(flag, path)| output::check_folder(flag, path, self.force))?;
        let recording = self.asked.open_one(&self.file, registry)?;
        let every = self.frames(&recording);
        if let Some((folder, name)) = &log {
            let path = folder.join(name);
            let written = mcap::write(&recording, every, NewFile::new(folder, name)?);
            written.map_err(|error| failed(&path, &error))?.finish()?;
        }
        for (flag, path) in folders {
            output::make_folder(path)?;
            for table in Table::ALL {
                write_table(flag == "--parquet", path, table, &recording, every)?;
            }
        }
        for path in [&self.mcap, &self.csv, &self.parquet].into_iter().flatten() {
            writeln!(out, "{}", path.display())?;
        }
        Ok(())
    }

    /// Number of frames of the recording between two exported states.
    fn frames(&self, recording: &Recording) -> usize {
        let frame_s = recording.header.dt_s * recording.header.steps_per_frame as f64;
        self.every.map_or(1, |every| (every / frame_s).round().max(1.0) as usize)
    }
}

fn write_table(
    is_parquet: bool,
    folder: &Path,
    table: Table,
    recording: &Recording,
    every: usize,
) -> Result<(), Failure> {
    let name = format!("{}.{}", table.name(), if is_parquet { "parquet" } else { "csv" });
    let file = NewFile::new(folder, &name)?;
    let failed = |error: ExportError| failed(&folder.join(&name), &error);
    let file = if is_parquet {
        let rows = table.write_csv(recording, every, Vec::new()).map_err(failed)?;
        parquet::from_csv(&*rows, Table::kind, file).map_err(failed)?
    } else {
        table.write_csv(recording, every, file).map_err(failed)?
    };
    file.finish().map(drop)
}
