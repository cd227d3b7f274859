//! Tables that users write, as CSV with a header.

use std::path::Path;

use csv::StringRecord;
use ron_tree::file::read_text;
use store::{Failure, refuse};

use crate::limits::{COLUMNS, TABLE_ROWS};

/// A table with its rows, each with its line in the file.
#[derive(Debug)]
pub struct InputTable {
    header: StringRecord,
    /// The rows, each with its line in the file, from 1.
    pub rows: Vec<(usize, StringRecord)>,
}

impl InputTable {
    /// Reads a table; cells are trimmed.
    ///
    /// # Errors
    /// The file cannot be read, a row has another number of cells than the header, or a column name occurs
    /// twice.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let shown = path.display();
        let text = read_text(path).map_err(Failure::input_at(path.display()))?;
        let text = text.as_str();
        let mut reader =
            csv::ReaderBuilder::new().trim(csv::Trim::All).flexible(true).from_reader(text.as_bytes());
        let header = reader.headers().map_err(Failure::input_at(path.display()))?.clone();
        let (columns, most) = (header.len(), COLUMNS.most);
        if columns > COLUMNS.count() {
            refuse!("{shown}:1: must have at most {most} columns, found {columns}");
        }
        let mut rows = Vec::new();
        let mut lines = Lines { text, upto: 0, line: 1 };
        for row in reader.records() {
            let row = row.map_err(Failure::input_at(path.display()))?;
            let line = lines.of(&row);
            if row.len() != header.len() {
                let (cells, columns) = (row.len(), header.len());
                refuse!("{shown}:{line}: must have a cell for each of the {columns} columns, found {cells}");
            }
            rows.push((line, row));
            if rows.len() > TABLE_ROWS.count() {
                refuse!("{shown}: must have at most {} rows", TABLE_ROWS.most);
            }
        }
        let table = Self { header, rows };
        let is_twice = |(i, name): &(usize, &str)| table.header.iter().take(*i).any(|other| other == *name);
        match table.header.iter().enumerate().find(is_twice) {
            Some((_, name)) => Err(Failure::input(format!("{shown}:1: the column {name:?} stands twice"))),
            None => Ok(table),
        }
    }

    /// The names of its columns.
    pub fn columns(&self) -> impl Iterator<Item = &str> {
        self.header.iter()
    }

    /// The place of a column.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|column| column == name)
    }
}

/// Counts the lines of a text. The CSV reader's own count is one too low where lines end with CR LF.
struct Lines<'t> {
    text: &'t str,
    /// Bytes counted so far.
    upto: usize,
    line: usize,
}

impl Lines<'_> {
    /// The line on which a row begins. Rows must come in their order.
    fn of(&mut self, row: &StringRecord) -> usize {
        let begin = row.position().map_or(0, |position| position.byte() as usize);
        let blank =
            self.text.as_bytes()[begin..].iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
        self.line += self.text[self.upto..begin + blank].matches('\n').count();
        self.upto = begin + blank;
        self.line
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<InputTable, Failure> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        std::fs::write(&path, text).unwrap();
        InputTable::read(&path)
    }

    #[test]
    fn rows_know_their_lines_whatever_the_line_ends() {
        for text in ["a,b\n1,2\n\n3,4\n", "a,b\r\n1,2\r\n\r\n3,4\r\n", "\u{feff}a,b\n1,2\n\n3,4"] {
            let table = read(text).unwrap();
            let lines: Vec<usize> = table.rows.iter().map(|(line, _)| *line).collect();
            assert_eq!(lines, [2, 4], "{text:?}");
            assert_eq!(table.column("b"), Some(1));
        }
        let table = read("a,b\n\"x\ny\",2\n3,4\n").unwrap();
        let lines: Vec<usize> = table.rows.iter().map(|(line, _)| *line).collect();
        assert_eq!(lines, [2, 4], "a cell may have lines of its own");
        let error = read("a,b\r\n1,2\r\n3\r\n").unwrap_err().to_string();
        assert!(
            error.contains("table.csv:3: must have a cell for each of the 2 columns, found 1"),
            "{error}"
        );
    }

    #[test]
    fn a_column_that_stands_twice_is_refused() {
        assert!(read("a,b,a\n").unwrap_err().to_string().contains(":1: the column \"a\" stands twice"));
    }
}
