//! Tables in pages: the one after the line `<!-- just movement: TITLE -->` is the table of this title.

use std::path::Path;

use experiments::Failure;

use super::tables::Table;

const MARK: &str = "<!-- just movement: ";

/// Replaces the tables of a page.
pub(super) fn renew(path: &Path, tables: &[Table]) -> Result<(), Failure> {
    let failed = |error| Failure::storage(format!("{}: {error}", path.display()));
    let page = std::fs::read_to_string(path).map_err(failed)?;
    std::fs::write(path, renewed(&page, tables)?).map_err(failed)
}

/// The page with its tables replaced.
fn renewed(page: &str, tables: &[Table]) -> Result<String, Failure> {
    let mut new = String::new();
    let mut lines = page.split_inclusive('\n').peekable();
    while let Some(line) = lines.next() {
        new.push_str(line);
        let title = line.trim_end().strip_prefix(MARK).and_then(|rest| rest.strip_suffix(" -->"));
        let Some(title) = title else { continue };
        let table = tables.iter().find(|table| table.title == title);
        let table = table.ok_or_else(|| Failure::input(format!("no table {title:?}")))?;
        while lines.next_if(|line| line.starts_with('|')).is_some() {}
        new.push_str(&table.rows);
    }
    Ok(new)
}
