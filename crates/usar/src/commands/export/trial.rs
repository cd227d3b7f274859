//! A recorded trial for other programs.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use experiments::Failure;
use experiments::files::NewFile;
use exports::{ExportError, parquet};
use recording::{Recording, Table};
use rne_core::Registry;

use crate::arguments::{ReplaceArgument, TrialArguments, seconds};
use crate::output::make_folder;

/// A recorded trial, or one that is recorded now.
#[derive(Debug, Args)]
pub(super) struct RecordedArguments {
    /// Recording (of `usar run --record`), scenario, which is simulated first, or folder of a sweep, whose trial
    /// is taken from its recordings or simulated again
    file: PathBuf,
    #[command(flatten)]
    trial: TrialArguments,
    /// Seconds of simulated time from one state or picture to the next [default: every frame of the
    /// recording]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub(super) every: Option<f64>,
}

impl RecordedArguments {
    /// The recording.
    pub(super) fn recording(&self, registry: &Registry) -> Result<Recording, Failure> {
        self.trial.recording(&self.file, registry)
    }

    /// The recording, and the number of its frames from one exported state to the next.
    pub(super) fn read(&self, registry: &Registry) -> Result<(Recording, usize), Failure> {
        let recording = self.recording(registry)?;
        let frame_s = recording.header.dt_s * recording.header.steps_per_frame as f64;
        let every = self.every.map_or(1, |every| (every / frame_s).round().max(1.0) as usize);
        Ok((recording, every))
    }
}

/// The failure of an export to a path.
pub(super) fn failed(path: &Path, error: &ExportError) -> Failure {
    match error {
        ExportError::Recording(_) => Failure::input(error),
        _ => Failure::storage(format!("{}: {error}", path.display())),
    }
}

/// The form of a table file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    Csv,
    Parquet,
}

/// A recorded trial, and a folder for its tables.
#[derive(Debug, Args)]
pub(super) struct TablesArguments {
    #[command(flatten)]
    recorded: RecordedArguments,
    /// File or folder to write
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
    #[command(flatten)]
    replace: ReplaceArgument,
}

impl TablesArguments {
    /// Writes all tables of the trial.
    pub(super) fn write(&self, form: Form, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        make_folder(&self.out, self.replace.force)?;
        let (recording, every) = self.recorded.read(registry)?;
        for table in Table::ALL {
            let ending = if form == Form::Csv { "csv" } else { "parquet" };
            let name = format!("{}.{ending}", table.name());
            let file = NewFile::new(&self.out, &name)?;
            let failed = |error: ExportError| failed(&self.out.join(&name), &error);
            let file = match form {
                Form::Csv => table.write_csv(&recording, every, file).map_err(failed)?,
                Form::Parquet => {
                    let rows = table.write_csv(&recording, every, Vec::new()).map_err(failed)?;
                    let columns = table.columns(&recording.header.world.needs);
                    parquet::from_csv(&*rows, &columns, file).map_err(failed)?
                }
            };
            file.finish()?;
        }
        Ok(writeln!(out, "{}", self.out.display())?)
    }
}
