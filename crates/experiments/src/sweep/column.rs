//! The columns of tables. A column is declared once: its name, type, unit and meaning, and how a row is read.
//! The tables, their dictionary and their Parquet files follow from it.

use exports::parquet::Kind;
use serde::Serialize;

/// What a table says of a column.
#[derive(Debug, Clone)]
pub(super) struct About {
    pub name: String,
    pub kind: Kind,
    /// Empty for a column without a unit.
    pub unit: &'static str,
    pub meaning: String,
}

impl About {
    pub(super) fn new(
        name: impl Into<String>,
        kind: Kind,
        unit: &'static str,
        meaning: impl Into<String>,
    ) -> Self {
        Self { name: name.into(), kind, unit, meaning: meaning.into() }
    }
}

/// A column of a table of which `R` is a row.
pub(super) struct Column<R> {
    pub about: About,
    read: Box<dyn Fn(&R) -> Cell>,
}

/// The columns of a table of which `R` is a row.
pub(super) type Columns<R> = Vec<Column<R>>;

impl<R> Column<R> {
    pub(super) fn new<C: Into<Cell>>(about: About, read: impl Fn(&R) -> C + 'static) -> Self {
        Self { about, read: Box::new(move |row| read(row).into()) }
    }

    /// The cell of a row.
    pub(super) fn read(&self, row: &R) -> Cell {
        (self.read)(row)
    }
}

/// What tables say of columns.
pub(super) fn abouts<R>(columns: Columns<R>) -> Vec<About> {
    columns.into_iter().map(|column| column.about).collect()
}

/// The value of a cell. A value that is not defined is an empty cell.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(super) enum Cell {
    Empty(Option<()>),
    Text(String),
    Natural(u64),
    Number(f64),
    Truth(bool),
}

impl Cell {
    /// A number in the fewest digits that read back exactly, without `.0` at the end.
    pub(super) fn short(value: Option<f64>) -> Self {
        value.map_or(Self::Empty(None), |value| Self::Text(value.to_string()))
    }

    /// A value that was measured.
    pub(super) fn number(&self) -> Option<f64> {
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
    f64 => Number(std::convert::identity);
    bool => Truth(std::convert::identity);
}

impl<T: Into<Self>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Empty(None), Into::into)
    }
}
