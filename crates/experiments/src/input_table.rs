//! Tables that users write, as CSV with a header. A spreadsheet may separate cells by `;` or tabs and write
//! decimal commas.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::Path;

use csv::StringRecord;
use ron_tree::file::{ReadError, read_text};
use store::{Failure, refuse};

use crate::limits::{COLUMNS, TABLE_ROWS};

/// Largest number of problems that are told of one table.
const MOST_PROBLEMS: usize = 20;

/// A table with its rows, each with its line in the file.
#[derive(Debug)]
pub struct InputTable {
    /// The name of the file, for messages.
    file: String,
    header: StringRecord,
    /// Whether numbers have decimal commas. Numbers with points are refused then: `1.234` may mean 1234.
    has_commas: bool,
    rows: Vec<(usize, StringRecord)>,
}

/// A row of a table.
#[derive(Debug, Clone, Copy)]
pub struct InputRow<'t> {
    table: &'t InputTable,
    cells: &'t StringRecord,
    /// Its line in the file, from 1.
    pub line: usize,
}

/// What is wrong with a cell, with the name of its column.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CellProblem {
    /// Nothing stands in it.
    #[error("{column}: is empty")]
    Empty {
        /// Name of the column.
        column: String,
    },
    /// Its text is of another kind, or out of range.
    #[error("{column}: must be {rule}, found {found:?}")]
    Broken {
        /// Name of the column.
        column: String,
        /// What it must be.
        rule: String,
        /// Its text.
        found: String,
    },
}

/// A problem and the line of the file where it is.
pub type Problem = (usize, String);

impl InputTable {
    /// Reads a table; cells are trimmed, and rows without any text left out.
    ///
    /// # Errors
    /// The file cannot be read; rows have another number of cells than the header; or a column has no name,
    /// or the name of another one.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let text = read_text(path).map_err(|error| unreadable(path, &error))?;
        if text.trim().is_empty() {
            refuse!("{}: is empty", path.display());
        }
        let separator = separator(&text);
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(separator)
            .trim(csv::Trim::All)
            .flexible(true)
            .from_reader(text.as_bytes());
        let header = reader.headers().map_err(Failure::input_at(path.display()))?.clone();
        let mut table =
            Self { file: path.display().to_string(), header, has_commas: false, rows: Vec::new() };
        let mut lines = Lines { text: &text, upto: 0, line: 1 };
        let mut problems = table.header_problems(lines.of(&table.header));
        for row in reader.records() {
            let row = row.map_err(Failure::input_at(path.display()))?;
            let line = lines.of(&row);
            if row.iter().all(str::is_empty) {
                continue;
            }
            problems.extend(table.row_problem(&row, separator).map(|problem| (line, problem)));
            table.has_commas |= separator != b',' && row.iter().any(|cell| with_comma(cell).is_some());
            table.rows.push((line, row));
            if table.rows.len() > TABLE_ROWS.count() {
                refuse!("{}: must have at most {} rows", table.file, TABLE_ROWS.most);
            }
        }
        if problems.is_empty() { Ok(table) } else { Err(table.refused(problems)) }
    }

    fn header_problems(&self, line: usize) -> Vec<Problem> {
        let (columns, most) = (self.header.len(), COLUMNS.most);
        if columns > COLUMNS.count() {
            return vec![(line, format!("must have at most {most} columns, found {columns}"))];
        }
        let problem = |(i, name): (usize, &str)| match name {
            "" => Some((line, format!("column {} has no name", i + 1))),
            name if self.column(name) != Some(i) => Some((line, format!("the column {name:?} stands twice"))),
            _ => None,
        };
        self.header.iter().enumerate().filter_map(problem).collect()
    }

    fn row_problem(&self, row: &StringRecord, separator: u8) -> Option<String> {
        let (cells, columns) = (row.len(), self.header.len());
        let hint = if cells > columns && separator == b',' {
            "; numbers with decimal commas need `;` between cells"
        } else {
            ""
        };
        (cells != columns)
            .then(|| format!("must have a cell for each of the {columns} columns, found {cells}{hint}"))
    }

    /// The names of its columns.
    pub fn columns(&self) -> impl Iterator<Item = &str> {
        self.header.iter()
    }

    /// The place of a column.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|column| column == name)
    }

    /// Its rows.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = InputRow<'_>> {
        self.rows.iter().map(|(line, cells)| InputRow { table: self, cells, line: *line })
    }

    /// The failure of a table with problems: all of them in the order of their lines, or the first 20.
    pub fn refused(&self, mut problems: Vec<Problem>) -> Failure {
        problems.sort_by_key(|(line, _)| *line);
        let mut lines: Vec<String> = problems
            .iter()
            .take(MOST_PROBLEMS)
            .map(|(line, problem)| self.refused_at(*line, problem).to_string())
            .collect();
        if problems.len() > MOST_PROBLEMS {
            lines.push(format!("{}: has {} more problems", self.file, problems.len() - MOST_PROBLEMS));
        }
        Failure::input(lines.join("\n"))
    }

    /// The failure of a table with one problem.
    pub fn refused_at(&self, line: usize, problem: impl Display) -> Failure {
        Failure::input(format!("{}:{line}: {problem}", self.file))
    }
}

impl<'t> InputRow<'t> {
    /// The text of a column; `None` if the table has no such column.
    pub fn text(&self, column: &str) -> Option<&'t str> {
        self.cells.get(self.table.column(column)?)
    }

    /// The number in a column; `None` if the table has no such column.
    ///
    /// # Errors
    /// The cell is empty, no number, or out of range.
    pub fn number(&self, column: &str, range: RangeInclusive<f64>) -> Result<Option<f64>, CellProblem> {
        let Some(found) = self.text(column) else { return Ok(None) };
        if found.is_empty() {
            return Err(CellProblem::Empty { column: column.to_owned() });
        }
        let value = self.table.value(found).filter(|value| range.contains(value));
        value.map(Some).ok_or_else(|| CellProblem::Broken {
            column: column.to_owned(),
            rule: self.table.rule(&range, found),
            found: found.to_owned(),
        })
    }
}

impl InputTable {
    fn value(&self, cell: &str) -> Option<f64> {
        match with_comma(cell) {
            Some(value) if self.has_commas => Some(value),
            _ if self.has_commas && cell.contains('.') => None,
            _ => cell.parse().ok(),
        }
    }

    /// What a number must be, in words.
    fn rule(&self, range: &RangeInclusive<f64>, found: &str) -> String {
        let (least, most) = (range.start(), range.end());
        let rule = match (*least > f64::MIN, *most < f64::MAX) {
            (false, _) => "a finite number".to_owned(),
            (true, false) => format!("a number >= {least}"),
            (true, true) => format!("a number from {least} to {most}"),
        };
        let is_mixed = self.has_commas && found.contains('.');
        if is_mixed { format!("{rule} with a decimal comma, as in other cells") } else { rule }
    }
}

fn unreadable(path: &Path, error: &ReadError) -> Failure {
    let hint =
        if matches!(error, ReadError::NotText(_)) { "; spreadsheets save it as CSV UTF-8" } else { "" };
    Failure::input(format!("{}: {error}{hint}", path.display()))
}

/// The number in a cell with one decimal comma.
fn with_comma(cell: &str) -> Option<f64> {
    let (whole, part) = cell.split_once(',')?;
    let has_digits = part.starts_with(|c: char| c.is_ascii_digit()) && !whole.contains('.');
    has_digits.then(|| format!("{whole}.{part}").parse().ok()).flatten()
}

/// What separates the cells: of `;`, tab and comma, the sign that is most frequent in the first line.
fn separator(text: &str) -> u8 {
    let first = text.trim_start().lines().next().unwrap_or_default();
    let unquoted: String = first.split('"').step_by(2).collect();
    let count = |sign: &u8| unquoted.bytes().filter(|byte| byte == sign).count();
    [b';', b'\t', b','].into_iter().rev().max_by_key(count).unwrap_or(b',')
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

    fn lines_of(table: &InputTable) -> Vec<usize> {
        table.rows().map(|row| row.line).collect()
    }

    #[test]
    fn rows_know_their_lines_whatever_the_line_ends() {
        for text in ["a,b\n1,2\n\n3,4\n", "a,b\r\n1,2\r\n\r\n3,4\r\n", "\u{feff}a,b\n1,2\n\n3,4"] {
            let table = read(text).unwrap();
            assert_eq!(lines_of(&table), [2, 4], "{text:?}");
            assert_eq!(table.column("b"), Some(1));
        }
        let table = read("a,b\n\"x\ny\",2\n3,4\n").unwrap();
        assert_eq!(lines_of(&table), [2, 4], "a cell may have lines of its own");
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

    #[test]
    fn a_spreadsheet_may_write_semicolons_tabs_and_decimal_commas() {
        let numbers = |text: &str| -> Vec<Option<f64>> {
            read(text).unwrap().rows().map(|row| row.number("b", 0.0..=f64::MAX).unwrap()).collect()
        };
        let expected = [Some(2.5), Some(3.0), Some(0.001)];
        assert_eq!(numbers("a;b\nx,y;2,5\n;;\n1;3\n1;1e-3\n"), expected);
        assert_eq!(numbers("a\tb\n1\t2,5\n1\t3\n1\t0,001\n"), expected);
        assert_eq!(numbers("a;b\n1.5;2.5\n1;3\n1;.001\n"), expected, "points, as nothing has a comma");
        assert_eq!(numbers("\"a;,;\",b\n1,2.5\n1,3\n1,0.001"), expected, "quoted signs do not count");
    }

    #[test]
    fn broken_numbers_are_told_with_column_and_rule() {
        let said = |text: &str| {
            let table = read(text).unwrap();
            let of = |row: InputRow| row.number("b", 0.0..=100.0).err().map(|problem| problem.to_string());
            table.rows().filter_map(of).collect::<Vec<String>>()
        };
        let rule = |found| format!("b: must be a number from 0 to 100, found \"{found}\"");
        assert_eq!(
            said("a,b\n1,\n1,nan\n1,inf\n1,-1\n1,\"1,5\"\n1,100"),
            ["b: is empty".to_owned(), rule("nan"), rule("inf"), rule("-1"), rule("1,5")]
        );
        let mixed = |found| {
            format!(
                "b: must be a number from 0 to 100 with a decimal comma, as in other cells, found \"{found}\""
            )
        };
        assert_eq!(
            said("a;b\n1;1,5\n1;1.234\n1;1.234,5\n1;1,2,3"),
            [mixed("1.234"), mixed("1.234,5"), rule("1,2,3")]
        );
    }

    #[test]
    fn problems_of_all_rows_are_told_at_once_up_to_20() {
        let error = read("a,\n1\n1,2,3\n").unwrap_err().to_string();
        let lines: Vec<&str> = error.lines().map(|line| line.split_once("csv:").unwrap().1).collect();
        assert_eq!(
            lines,
            [
                "1: column 2 has no name",
                "2: must have a cell for each of the 2 columns, found 1",
                "3: must have a cell for each of the 2 columns, found 3; numbers with decimal commas need \
                 `;` between cells"
            ]
        );
        let error = read(&format!("a,b\n{}", "1\n".repeat(30))).unwrap_err().to_string();
        assert_eq!(error.lines().count(), 21);
        assert!(error.ends_with("table.csv: has 10 more problems"), "{error}");
    }
}
