//! A recorded trial for other programs.

use std::path::{Path, PathBuf};

use clap::Args;
use experiments::Failure;
use experiments::files::NewFile;
use exports::{ExportError, parquet};
use recording::{Recording, Table};
use rne_core::Registry;

use crate::arguments::{TrialArguments, seconds};

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

/// Writes all tables of a trial to a folder.
pub(super) fn write_tables(
    recorded: &RecordedArguments,
    folder: &Path,
    form: Form,
    registry: &Registry,
) -> Result<(), Failure> {
    let (recording, every) = recorded.read(registry)?;
    for table in Table::ALL {
        let ending = if form == Form::Csv { "csv" } else { "parquet" };
        let name = format!("{}.{ending}", table.name());
        let file = NewFile::new(folder, &name)?;
        let failed = |error: ExportError| failed(&folder.join(&name), &error);
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
    Ok(())
}
