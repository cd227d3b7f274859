//! Tables as people read them: a header, and rows of texts.

use comfy_table::presets::UTF8_FULL_CONDENSED;
use comfy_table::{Cell, CellAlignment};
use serde::Serialize;
use serde_json::{Number, Value};

/// A text in a table.
#[derive(Debug, Clone)]
pub struct Entry {
    /// The text.
    pub text: String,
    /// What programs get instead of the text.
    value: Option<Value>,
    is_right: bool,
}

impl Entry {
    /// The same text; programs get this value instead.
    #[must_use]
    pub fn with(self, value: impl Serialize) -> Self {
        Self { value: serde_json::to_value(value).ok(), ..self }
    }

    /// The entry for programs: its value in full; without one, the number or the text that it is.
    pub(crate) fn json(&self) -> Value {
        let number = || serde_json::from_str::<Number>(&self.text).ok().filter(|_| self.is_right);
        match &self.value {
            Some(value) => value.clone(),
            None if self.text == "-" => Value::Null,
            None => number().map_or_else(|| self.text.trim().into(), Value::Number),
        }
    }
}

impl<T: ToString> From<T> for Entry {
    fn from(text: T) -> Self {
        Self { text: text.to_string(), value: None, is_right: false }
    }
}

/// An entry aligned on the right.
pub fn right(text: impl ToString) -> Entry {
    Entry { is_right: true, ..text.into() }
}

/// An entry aligned on the right that is this value for programs.
pub fn valued(value: impl Serialize, text: impl ToString) -> Entry {
    right(text).with(value)
}

/// A value as an entry aligned on the right; a dash if there is none.
pub fn right_or_dash<T: Serialize + Copy>(value: Option<T>, text: impl FnOnce(T) -> String) -> Entry {
    valued(value, or_dash(value, text))
}

/// A value as text; a dash if there is none.
pub fn or_dash<T>(value: Option<T>, text: impl FnOnce(T) -> String) -> String {
    value.map_or("-".to_owned(), text)
}

/// A row that begins with its name.
pub fn labelled(name: impl Into<Entry>, cells: impl IntoIterator<Item: Into<Entry>>) -> Vec<Entry> {
    std::iter::once(name.into()).chain(cells.into_iter().map(Into::into)).collect()
}

/// A table of texts.
#[derive(Debug, Clone)]
pub struct Table {
    /// The names of the columns.
    pub header: Vec<Entry>,
    /// The rows. A row may end before the last column.
    pub rows: Vec<Vec<Entry>>,
}

impl Table {
    /// A table without rows.
    pub fn new(header: impl IntoIterator<Item: Into<Entry>>) -> Self {
        Self { header: entries(header), rows: Vec::new() }
    }

    /// A table with these rows.
    pub fn of<R: IntoIterator<Item: Into<Entry>>>(
        header: impl IntoIterator<Item: Into<Entry>>,
        rows: impl IntoIterator<Item = R>,
    ) -> Self {
        Self { header: entries(header), rows: rows.into_iter().map(entries).collect() }
    }

    /// Adds a row.
    pub fn add(&mut self, row: impl IntoIterator<Item: Into<Entry>>) {
        self.rows.push(entries(row));
    }

    /// The table with box lines.
    pub(crate) fn boxed(&self) -> String {
        let cell = |Entry { text, is_right, .. }: &Entry| {
            let cell = Cell::new(text);
            if *is_right { cell.set_alignment(CellAlignment::Right) } else { cell }
        };
        let cells = |row: &Vec<Entry>| row.iter().map(cell).collect::<Vec<Cell>>();
        let mut table = comfy_table::Table::new();
        table.load_style(UTF8_FULL_CONDENSED).set_header(cells(&self.header));
        table.add_rows(self.rows.iter().map(cells));
        format!("{table}\n")
    }
}

fn entries(row: impl IntoIterator<Item: Into<Entry>>) -> Vec<Entry> {
    row.into_iter().map(Into::into).collect()
}
