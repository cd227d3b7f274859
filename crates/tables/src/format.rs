//! The forms of a table: for the terminal, and for other programs.

use std::io;
use std::sync::OnceLock;

use serde_json::Value;

use crate::blocks::in_blocks;
use crate::rows::csv;
use crate::text::{Entry, Table};

/// Output formats of tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Format {
    /// With box lines, for the terminal.
    #[default]
    Table,
    /// As Markdown.
    Markdown,
    /// As comma-separated values.
    Csv,
    /// As a `tabular` of LaTeX with the lines of its package booktabs.
    Latex,
    /// As a JSON array with an object for each row.
    Json,
}

static FORMAT: OnceLock<Format> = OnceLock::new();

/// Sets the format of all tables; the first call decides.
pub fn show_as(format: Format) {
    let _ = FORMAT.set(format); // the command line is the same
}

/// The format of tables.
pub fn shown_as() -> Format {
    FORMAT.get().copied().unwrap_or_default()
}

/// Width of the terminal in columns, if there is one.
static COLUMNS: OnceLock<u16> = OnceLock::new();

/// Shows tables that are wider than a terminal with this many columns in parts. Without this call, tables
/// keep their full width.
pub fn fold_at(columns: u16) {
    let _ = COLUMNS.set(columns); // the terminal is the same
}

/// Tables with many columns are for terminals of at least so many.
const WIDE: u16 = 120;

/// Whether a table may have many columns: in a wide terminal, and where programs or pages read it.
pub fn is_wide() -> bool {
    shown_as() != Format::Table || COLUMNS.get().is_some_and(|columns| *columns >= WIDE)
}

impl Format {
    /// Whether the output may contain nothing but tables.
    pub fn is_for_programs(self) -> bool {
        matches!(self, Self::Csv | Self::Latex | Self::Json)
    }

    /// A table as text that ends with a line break.
    ///
    /// # Errors
    /// None: it is written to memory.
    pub fn write(self, table: &Table) -> io::Result<String> {
        let (header, rows) = table.lines();
        Ok(match self {
            Self::Table => {
                COLUMNS.get().map_or_else(|| table.boxed(), |columns| in_blocks(table, usize::from(*columns)))
            }
            Self::Markdown => markdown(&header, &rows),
            Self::Csv => csv(&header, rows)?,
            Self::Latex => latex(&header, &rows),
            Self::Json => format!("[{}]\n", table.objects()?.join(",")),
        })
    }
}

impl Table {
    /// The header and the other rows, each as long as the header. A column name that occurs more than once is
    /// prefixed with the name of the column before it.
    pub fn lines(&self) -> (Vec<String>, Vec<Vec<String>>) {
        let cells = |row: &Vec<Entry>| -> Vec<String> {
            row.iter().map(|entry| entry.text.replace('\n', " ").trim().to_owned()).collect()
        };
        let names = cells(&self.header);
        let unique = |(i, name): (usize, &String)| {
            let is_repeated = names[..i].contains(name) || names[i + 1..].contains(name);
            if is_repeated && i > 0 { format!("{} {name}", names[i - 1]) } else { name.clone() }
        };
        let full = |row: &Vec<Entry>| {
            let mut cells = cells(row);
            cells.resize(cells.len().max(names.len()), String::new());
            cells
        };
        (names.iter().enumerate().map(unique).collect(), self.rows.iter().map(full).collect())
    }

    /// The rows as objects of JSON, whose fields keep the order of the columns.
    ///
    /// # Errors
    /// None: they are written to memory.
    pub fn objects(&self) -> io::Result<Vec<String>> {
        let (header, _) = self.lines();
        let object = |row: &Vec<Entry>| {
            let cells = row.iter().map(Entry::json).chain(std::iter::repeat(Value::Null));
            let field = |(name, cell)| Ok(format!("{}:{cell}", serde_json::to_string(name)?));
            Ok(format!(
                "{{{}}}",
                header.iter().zip(cells).map(field).collect::<io::Result<Vec<_>>>()?.join(",")
            ))
        };
        self.rows.iter().map(object).collect()
    }
}

/// The alignment of each column: on the right, as columns of numbers are, or on the left.
fn alignments<T: Clone>(header: &[String], rows: &[Vec<String>], [left, right]: [T; 2]) -> Vec<T> {
    let is_number = |cell: &String| cell.starts_with(|c: char| c.is_ascii_digit() || "-+<".contains(c));
    let is_right = |column| !rows.is_empty() && rows.iter().all(|row: &Vec<String>| is_number(&row[column]));
    (0..header.len()).map(|column| if is_right(column) { right.clone() } else { left.clone() }).collect()
}

fn markdown(header: &[String], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let escaped =
        |cells: &[String]| line(&cells.iter().map(|cell| cell.replace('|', "\\|")).collect::<Vec<_>>());
    let rules = alignments(header, rows, ["---", "---:"].map(str::to_owned));
    let rows = rows.iter().map(|row| escaped(row)).collect::<String>();
    format!("\n{}{}{rows}\n", escaped(header), line(&rules))
}

fn latex(header: &[String], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| {
        let cells: Vec<String> = cells.iter().map(|cell| escaped(cell)).collect();
        format!("{} \\\\\n", cells.join(" & "))
    };
    let columns: String = alignments(header, rows, ['l', 'r']).into_iter().collect();
    let rows = rows.iter().map(|row| line(row)).collect::<String>();
    format!(
        "\\begin{{tabular}}{{{columns}}}\n\\toprule\n{}\\midrule\n{rows}\\bottomrule\n\\end{{tabular}}\n",
        line(header)
    )
}

/// Text escaped for LaTeX.
fn escaped(text: &str) -> String {
    let letter = |c: char| match c {
        '&' | '%' | '$' | '#' | '_' | '{' | '}' => format!("\\{c}"),
        '\\' => "\\textbackslash{}".to_owned(),
        '~' => "\\textasciitilde{}".to_owned(),
        '^' => "\\textasciicircum{}".to_owned(),
        '±' => "$\\pm$".to_owned(),
        '<' | '>' => format!("${c}$"),
        _ => c.to_string(),
    };
    text.chars().map(letter).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::{right, valued};

    fn table() -> Table {
        let mut table = Table::new(["policy", "mean, sd"]);
        table.add(["A_1|x".into(), valued([3.5, 1.0], "3.5 ± 1")]);
        table.add(["  b & c".into(), right("< 1 %")]);
        table
    }

    #[track_caller]
    fn is(format: Format, text: &str) {
        assert_eq!(format.write(&table()).unwrap(), text);
    }

    #[test]
    fn a_table_can_be_pasted_where_it_is_needed() {
        is(
            Format::Markdown,
            "\n| policy | mean, sd |\n| --- | ---: |\n| A_1\\|x | 3.5 ± 1 |\n| b & c | < 1 % |\n\n",
        );
        is(Format::Csv, "policy,\"mean, sd\"\nA_1|x,3.5 ± 1\nb & c,< 1 %\n");
        is(
            Format::Latex,
            "\\begin{tabular}{lr}\n\\toprule\npolicy & mean, sd \\\\\n\\midrule\nA\\_1|x & 3.5 $\\pm$ \
             1 \\\\\nb \\& c & $<$ 1 \\% \\\\\n\
             \\bottomrule\n\\end{tabular}\n",
        );
        is(
            Format::Json,
            "[{\"policy\":\"A_1|x\",\"mean, sd\":[3.5,1.0]},{\"policy\":\"b & c\",\"mean, sd\":\"< \
             1 %\"}]\n",
        );
        assert!(Format::Table.write(&table()).unwrap().starts_with('┌'));
    }

    #[test]
    fn a_short_row_has_all_columns() {
        let mut table = Table::new(["a", "b", "c"]);
        table.add(["1"]);
        assert_eq!(Format::Csv.write(&table).unwrap(), "a,b,c\n1,,\n");
        assert_eq!(Format::Json.write(&table).unwrap(), "[{\"a\":\"1\",\"b\":null,\"c\":null}]\n");
        assert_eq!(Format::Markdown.write(&table).unwrap().lines().nth(3), Some("| 1 |  |  |"));
    }
}
