//! A trial for other programs: its log, and its tables as Parquet.

use exports::{ExportError, parquet};
use recording::{Recording, Table};

use super::Arguments;
use crate::prelude::*;

impl Arguments {
    pub(super) fn write_log(&self, registry: &Registry) -> Result<(), Failure> {
        let to = self.destination(&self.to)?;
        let (recording, every) = self.read(registry)?;
        let written = exports::mcap::write(&recording, every, to.begin()?);
        written.map_err(|error| failed(&self.to, &error))?.finish().map(drop)
    }
}

/// Writes a table of a trial as Parquet.
pub(super) fn write_parquet(
    recording: &Recording,
    table: Table,
    every: usize,
    path: &Path,
    to: &Destination,
) -> Result<(), Failure> {
    let failed = |error: ExportError| failed(path, &error);
    let rows = table.write_csv(recording, every, Vec::new()).map_err(failed)?;
    let columns = table.columns(&recording.header.world.needs);
    parquet::from_csv(&*rows, &columns, to.begin()?).map_err(failed)?.finish().map(drop)
}

/// The failure of an export to a path.
fn failed(path: &Path, error: &ExportError) -> Failure {
    match error {
        ExportError::Recording(_) => Failure::input(error.to_string()),
        _ => Failure::storage(format!("{}: {error}", path.display())),
    }
}
