//! The tables of a finished sweep as Parquet files beside them. They are made from the tables alone, and
//! are not part of the hashed results.

use std::path::Path;

use exports::ExportError;
use exports::parquet::{Kind, from_csv};
use store::Failure;
use store::files::{self, NewFile, file_hash};

use super::column::About;
use super::folder::Folder;
use super::names::PARQUETS;
use super::rows;
use super::tables::{TABLES, all_columns};
use crate::experiment::Experiment;

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
    let cells = files::open(table).map_err(|error| failed(error.into()))?;
    let place = TABLES.iter().position(|known| table.ends_with(known)).unwrap_or_default();
    let own = std::mem::take(&mut all_columns(experiment)[place]);
    let columns: Vec<About> = rows::before(&experiment.axes).into_iter().chain(own).collect();
    let kind = |name: &str| columns.iter().find(|about| about.name == name).map_or(Kind::Text, |it| it.kind);
    let file = from_csv(std::io::BufReader::new(cells), kind, NewFile::new(folder, name)?);
    file.map_err(failed)?.finish().map(drop)
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
