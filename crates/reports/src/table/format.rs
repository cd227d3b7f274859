//! Tables as text, for the terminal or for other programs.

use std::sync::OnceLock;

use comfy_table::{Row, Table};
use experiments::Failure;

use super::blocks::in_blocks;
use super::columns;

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

impl Format {
    /// Whether the output may contain nothing but tables.
    pub fn is_for_programs(self) -> bool {
        matches!(self, Self::Csv | Self::Latex | Self::Json)
    }

    /// A table as text that ends with a line break.
    ///
    /// # Errors
    /// None: it is written to memory.
    pub fn write(self, table: &Table) -> Result<String, Failure> {
        Ok(match self {
            Self::Table => {
                columns().map_or_else(|| format!("{table}\n"), |columns| in_blocks(table, columns))
            }
            Self::Markdown => markdown(table),
            Self::Csv => csv(table)?,
            Self::Latex => latex(table),
            Self::Json => json(table)?,
        })
    }
}

fn cells(row: &Row) -> Vec<String> {
    row.cell_iter().map(|cell| cell.content().replace('\n', " ").trim().to_owned()).collect()
}

/// The header and the other rows, each as long as the header. A column name that occurs more than once is
/// prefixed with the name of the column before it.
fn lines(table: &Table) -> (Vec<String>, Vec<Vec<String>>) {
    let names = table.header().map(cells).unwrap_or_default();
    let unique = |(i, name): (usize, &String)| {
        let is_repeated = names[..i].contains(name) || names[i + 1..].contains(name);
        if is_repeated && i > 0 { format!("{} {name}", names[i - 1]) } else { name.clone() }
    };
    let full = |row: &Row| {
        let mut cells = cells(row);
        cells.resize(cells.len().max(names.len()), String::new());
        cells
    };
    (names.iter().enumerate().map(unique).collect(), table.row_iter().map(full).collect())
}

/// The texts of a table, for an HTML page.
pub(crate) struct Lines {
    pub header: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

impl Lines {
    pub fn of(table: &Table) -> Self {
        let (header, rows) = lines(table);
        Self { header, rows }
    }
}

/// Whether each column is aligned on the right, as columns of numbers are.
fn are_right(rows: &[Vec<String>]) -> Vec<bool> {
    let is_number = |cell: &String| cell.starts_with(|c: char| c.is_ascii_digit() || "-+<".contains(c));
    let columns = rows.first().map_or(0, Vec::len);
    (0..columns).map(|column| rows.iter().all(|row| row.get(column).is_some_and(is_number))).collect()
}

fn markdown(table: &Table) -> String {
    let (header, rows) = lines(table);
    let line = |cells: &[String]| {
        let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let right = are_right(&rows);
    let rule = |column: usize| if right.get(column) == Some(&true) { "---:" } else { "---" };
    let rules: Vec<String> = (0..header.len()).map(|column| rule(column).to_owned()).collect();
    let rows = rows.iter().map(|row| line(row)).collect::<String>();
    format!("\n{}{}{rows}\n", line(&header), line(&rules))
}

fn csv(table: &Table) -> Result<String, Failure> {
    let (header, rows) = lines(table);
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    crate::drawing::table(&header, rows)
}

fn json(table: &Table) -> Result<String, Failure> {
    let (header, rows) = lines(table);
    let text = |text: &String| serde_json::to_string(text).map_err(Failure::run);
    // Written by hand, so that the columns keep their order.
    let object = |row: &Vec<String>| {
        let cells = header.iter().zip(row).map(|(name, cell)| Ok(format!("{}:{}", text(name)?, text(cell)?)));
        Ok(format!("{{{}}}", cells.collect::<Result<Vec<_>, Failure>>()?.join(",")))
    };
    let rows = rows.iter().map(object).collect::<Result<Vec<_>, Failure>>()?;
    Ok(format!("[{}]\n", rows.join(",")))
}

fn latex(table: &Table) -> String {
    let (header, rows) = lines(table);
    let line = |cells: &[String]| {
        let cells: Vec<String> = cells.iter().map(|cell| escaped(cell)).collect();
        format!("{} \\\\\n", cells.join(" & "))
    };
    let right = are_right(&rows);
    let columns: String =
        (0..header.len()).map(|column| if right.get(column) == Some(&true) { 'r' } else { 'l' }).collect();
    let rows = rows.iter().map(|row| line(row)).collect::<String>();
    format!(
        "\\begin{{tabular}}{{{columns}}}\n\\toprule\n{}\\midrule\n{rows}\\bottomrule\n\\end{{tabular}}\n",
        line(&header)
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
    use comfy_table::Cell;

    use super::*;
    use crate::table::{headed, right};

    fn table() -> Table {
        let mut table = headed(["policy", "mean, sd"]);
        table.add_row([Cell::new("A_1|x"), right("3.5 ± 1")]);
        table.add_row([Cell::new("  b & c"), right("< 1 %")]);
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
            "[{\"policy\":\"A_1|x\",\"mean, sd\":\"3.5 ± 1\"},{\"policy\":\"b & c\",\"mean, sd\":\"< \
             1 %\"}]\n",
        );
        assert!(Format::Table.write(&table()).unwrap().starts_with('┌'));
    }

    #[test]
    fn a_short_row_has_all_columns() {
        let mut table = headed(["a", "b", "c"]);
        table.add_row([Cell::new("1")]);
        assert_eq!(Format::Csv.write(&table).unwrap(), "a,b,c\n1,,\n");
        assert_eq!(Format::Markdown.write(&table).unwrap().lines().nth(3), Some("| 1 |  |  |"));
    }
}
