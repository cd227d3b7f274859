//! The tables of a finished sweep as Parquet files beside them. They are made from the tables alone, and
//! are not part of the hashed results.

use std::path::Path;

use exports::ExportError;
use exports::parquet::{Kind, from_csv};

use super::folder::Folder;
use super::names::PARQUETS;
use super::tables::TABLES;
use crate::experiment::Experiment;
use crate::failure::Failure;
use crate::files::{self, NewFile, file_hash};

/// The table in which the columns `stranded` and `disabled` are no counts.
const ROBOTS: &str = "robots.csv";

/// Writes the tables of a finished sweep as Parquet.
///
/// # Errors
/// A table is missing, or the disk does not take it.
pub fn write_parquet(folder: &Folder) -> Result<(), Failure> {
    let path = folder.path();
    for (table, name) in TABLES.iter().zip(PARQUETS).filter(|(table, _)| path.join(table).exists()) {
        write(&path.join(table), folder.experiment(), path, name)?;
    }
    Ok(())
}

fn write(table: &Path, experiment: &Experiment, folder: &Path, name: &str) -> Result<(), Failure> {
    let failed = |error: ExportError| Failure::storage(format!("{}: {error}", table.display()));
    let rows = files::open(table).map_err(|error| failed(error.into()))?;
    let file = from_csv(
        std::io::BufReader::new(rows),
        |column| kind(table, column, experiment),
        NewFile::new(folder, name)?,
    );
    file.map_err(failed)?.finish().map(drop)
}

/// The type of a table's column.
fn kind(table: &Path, column: &str, experiment: &Experiment) -> Kind {
    if let Some(axis) = experiment.axes.iter().find(|axis| axis.path == column) {
        let are_numbers = axis.values.iter().all(|value| value.parse::<f64>().is_ok());
        return if are_numbers { Kind::Number } else { Kind::Text };
    }
    match column {
        "case" | "trial" | "seed" | "round" | "robot" | "step" | "turned_back" | "stall_waits_for" => {
            Kind::Natural
        }
        "stranded" | "disabled" if table.ends_with(ROBOTS) => Kind::Truth,
        "method" | "policy" | "status" | "state_hash" | "failure" | "replay" | "task" | "members"
        | "return_cause" | "role" | "stall_cause" | "digest" | "parts" => Kind::Text,
        _ => Kind::Number,
    }
}

/// The Parquet files in the folder that differ from their tables, one sentence each.
///
/// # Errors
/// There is no room in the folder of temporary files.
pub(super) fn strange(path: &Path, experiment: &Experiment) -> Result<Vec<String>, Failure> {
    let place = tempfile::tempdir()?;
    let mut strange = Vec::new();
    for (table, name) in
        TABLES.iter().zip(PARQUETS).filter(|(_, name)| path.join(name).symlink_metadata().is_ok())
    {
        let made = write(&path.join(table), experiment, place.path(), name);
        let is_same =
            made.is_ok() && file_hash(&path.join(name)).ok() == file_hash(&place.path().join(name)).ok();
        if !is_same {
            strange.push(format!("{}: is not what {table} gives", path.join(name).display()));
        }
    }
    Ok(strange)
}
