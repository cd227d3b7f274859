//! The tables of a finished sweep as Parquet files beside them. They are made from the tables alone, and
//! are not part of the hashed results.

use std::path::Path;

use experiments::Failure;
use experiments::files::{self, NewFile, file_hash};
use experiments::sweep::folder::Folder;
use experiments::sweep::{Described, described};
use exports::ExportError;
use exports::parquet::from_csv;

/// Writes the tables of a finished sweep as Parquet.
pub(crate) fn write_parquets(folder: &Folder) -> Result<(), Failure> {
    let path = folder.path();
    let tables = described(folder.experiment());
    tables.iter().filter(|table| path.join(table.csv).exists()).try_for_each(|table| write(table, path, path))
}

/// Writes a table in `from` as Parquet into `to`.
fn write(table: &Described, from: &Path, to: &Path) -> Result<(), Failure> {
    let csv = from.join(table.csv);
    let failed = |error: ExportError| Failure::storage(format!("{}: {error}", csv.display()));
    let cells = files::open(&csv).map_err(|error| failed(error.into()))?;
    let file = NewFile::new(to, table.parquet)?;
    from_csv(std::io::BufReader::new(cells), &table.columns, file).map_err(failed)?.finish().map(drop)
}

/// The Parquet files in a sweep's folder that differ from their tables, one sentence each.
pub(crate) fn strange_parquets(folder: &Folder) -> Result<Vec<String>, Failure> {
    let (path, place) = (folder.path(), tempfile::tempdir()?);
    let is_there = |table: &Described| path.join(table.parquet).symlink_metadata().is_ok();
    let is_same = |table: &Described| {
        let hash = |folder: &Path| file_hash(&folder.join(table.parquet)).ok();
        write(table, path, place.path()).is_ok() && hash(path) == hash(place.path())
    };
    let tables = described(folder.experiment());
    let strange = tables.iter().filter(|table| is_there(table) && !is_same(table));
    let tell = |Described { csv, parquet, .. }: &Described| {
        format!("{}: is not what {csv} gives", path.join(parquet).display())
    };
    Ok(strange.map(tell).collect())
}
