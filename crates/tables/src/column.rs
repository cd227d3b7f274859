//! Columns, and the cells that they read from rows.

use serde::Serialize;

/// The type of a column. In any column, an empty cell is a missing value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Whole numbers from 0 on.
    Natural,
    /// Numbers.
    Number,
    /// `true` or `false`.
    Truth,
    /// Texts.
    Text,
}

impl Kind {
    /// Its name in JSON schemas and data packages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Natural => "integer",
            Self::Number => "number",
            Self::Truth => "boolean",
            Self::Text => "string",
        }
    }
}

/// What a table says of a column.
#[derive(Debug, Clone)]
pub struct About {
    /// Its name.
    pub name: String,
    /// Its type.
    pub kind: Kind,
    /// Its unit; empty for a column without one.
    pub unit: &'static str,
    /// Its meaning, in a sentence.
    pub meaning: String,
}

impl About {
    /// A column with this name, type, unit and meaning.
    pub fn new(name: impl Into<String>, kind: Kind, unit: &'static str, meaning: impl Into<String>) -> Self {
        Self { name: name.into(), kind, unit, meaning: meaning.into() }
    }
}

/// A column of a table of which `R` is a row.
pub struct Column<R> {
    /// What the table says of it.
    pub about: About,
    read: Box<dyn Fn(&R) -> Cell>,
}

/// The columns of a table of which `R` is a row.
pub type Columns<R> = Vec<Column<R>>;

impl<R> Column<R> {
    /// A column of which `read` gives the cell of a row.
    pub fn new<C: Into<Cell>>(about: About, read: impl Fn(&R) -> C + 'static) -> Self {
        Self { about, read: Box::new(move |row| read(row).into()) }
    }

    /// The cell of a row.
    pub fn read(&self, row: &R) -> Cell {
        (self.read)(row)
    }
}

/// The columns of a table with rows of this type: name, kind, unit, meaning, and how a row is read.
#[macro_export]
macro_rules! columns {
    ($row:ty: $($name:expr, $kind:ident, $unit:expr, $meaning:expr, |$it:ident| $read:expr;)+) => {
        vec![$($crate::Column::new(
            $crate::About::new($name, $crate::Kind::$kind, $unit, $meaning),
            |$it: &$row| $read,
        )),+]
    };
}

/// What a table says of its columns.
pub fn abouts<R>(columns: Columns<R>) -> Vec<About> {
    columns.into_iter().map(|column| column.about).collect()
}

/// The value of a cell. A value that is not defined is an empty cell.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub enum Cell {
    /// No value.
    Empty(Option<()>),
    /// A text.
    Text(String),
    /// A whole number.
    Natural(u64),
    /// A number.
    Number(f64),
    /// `true` or `false`.
    Truth(bool),
}

impl Cell {
    /// A number in the fewest digits that read back exactly, without `.0` at the end.
    pub fn short(value: impl Into<Option<f64>>) -> Self {
        value.into().map_or(Self::Empty(None), |value| Self::Text(value.to_string()))
    }

    /// A value that was measured.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Natural(value) => Some(*value as f64),
            Self::Number(value) => Some(*value),
            Self::Empty(_) | Self::Text(_) | Self::Truth(_) => None,
        }
    }
}

/// Cells of plain values.
macro_rules! cells {
    ($($type:ty => $variant:ident($convert:expr);)+) => {
        $(impl From<$type> for Cell {
            fn from(value: $type) -> Self {
                Self::$variant($convert(value))
            }
        })+
    };
}

cells! {
    &str => Text(str::to_owned);
    String => Text(std::convert::identity);
    u32 => Natural(u64::from);
    u64 => Natural(std::convert::identity);
    usize => Natural(|value| value as u64);
    f64 => Number(std::convert::identity);
    bool => Truth(std::convert::identity);
}

impl<T: Into<Self>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Empty(None), Into::into)
    }
}
