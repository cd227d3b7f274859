//! Rows of a table as CSV. No cell of them is a formula to a spreadsheet.

use std::borrow::Cow;
use std::io::{self, Write};

use csv::{Writer, WriterBuilder};

use crate::column::{About, Cell, Column};

/// A table that is being written as CSV.
pub struct Csv<W: Write>(Writer<W>);

impl<W: Write> Csv<W> {
    /// A table without rows.
    pub fn new(out: W) -> Self {
        Self(WriterBuilder::new().has_headers(false).flexible(true).from_writer(out))
    }

    /// Writes the names of the columns.
    ///
    /// # Errors
    /// The output does not take them.
    pub fn add_names(&mut self, columns: &[About]) -> io::Result<()> {
        Ok(self.0.write_record(columns.iter().map(|about| &about.name))?)
    }

    /// Adds rows, each with the cells `before` in front of its own.
    ///
    /// # Errors
    /// The output does not take them.
    pub fn add<R>(
        &mut self,
        before: &[String],
        columns: &[Column<R>],
        mut rows: impl Iterator<Item = R>,
    ) -> io::Result<()> {
        rows.try_for_each(|row| {
            let cells = columns.iter().map(|column| column.read(&row));
            let guarded = |cell| match cell {
                Cell::Text(text) => Cell::Text(guarded(&text).into_owned()),
                other => other,
            };
            Ok(self.0.serialize((before, cells.map(guarded).collect::<Vec<_>>()))?)
        })
    }

    /// Adds one row of texts.
    ///
    /// # Errors
    /// The output does not take it.
    pub fn add_row(&mut self, cells: impl IntoIterator<Item: AsRef<str>>) -> io::Result<()> {
        Ok(self.0.write_record(cells.into_iter().map(|cell| guarded(cell.as_ref()).into_owned()))?)
    }

    /// Returns the output when everything is written.
    ///
    /// # Errors
    /// The output does not take the rest.
    pub fn finish(self) -> io::Result<W> {
        self.0.into_inner().map_err(csv::IntoInnerError::into_error)
    }
}

/// A table of texts as CSV.
///
/// # Errors
/// None: it is written to memory.
pub fn csv(
    header: impl IntoIterator<Item: AsRef<str>>,
    rows: impl IntoIterator<Item = Vec<String>>,
) -> io::Result<String> {
    let mut csv = Csv::new(Vec::new());
    csv.add_row(header)?;
    rows.into_iter().try_for_each(|row| csv.add_row(row))?;
    String::from_utf8(csv.finish()?).map_err(io::Error::other)
}

/// A text as a cell that no spreadsheet takes for a formula: with an apostrophe in front, if it begins like
/// one and is no number and no range of numbers.
fn guarded(text: &str) -> Cow<'_, str> {
    let is_formula = match text.chars().next() {
        Some('=' | '@' | '\t' | '\r') => true,
        Some('+' | '-') => {
            text[1..].starts_with(|c: char| !c.is_ascii_digit() && !". <\u{221e}".contains(c))
                || text.contains(['(', '!', '|', '='])
        }
        _ => false,
    };
    if is_formula { Cow::Owned(format!("'{text}")) } else { Cow::Borrowed(text) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_formula_is_a_text_and_a_number_stays_one() {
        for text in ["=1+1", "@sum", "+cmd|' /C calc'!A0", "-1+cmd|x", "-A1", "\tx", "+1*(2)"] {
            assert_eq!(guarded(text), format!("'{text}"));
        }
        for text in ["", "-", "+", "-1.5", "+2e-3", "-12.1 to -7.40", "- 3", "RNE", "a=b", "-inf"] {
            let expected = if text == "-inf" { "'-inf" } else { text };
            assert_eq!(guarded(text), expected);
        }
    }
}
