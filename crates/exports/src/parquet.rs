//! Tables in CSV as Parquet files.

use std::io::{Read, Write};
use std::sync::Arc;

use parquet::basic::{Compression, ConvertedType, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;
use tables::{About, Kind};

use crate::error::ExportError;

/// Largest number of rows in a row group.
const ROWS: usize = 1 << 16;
/// The column by whose values rows are grouped.
const CASE: &str = "case";

/// Writes a CSV table with a header as Parquet. A column that is none of `columns` is one of texts. The same
/// table gives the same bytes.
///
/// # Errors
/// The table cannot be read, a cell is not of its column's kind, or the file cannot be written.
pub fn from_csv<W: Write + Send>(table: impl Read, columns: &[About], out: W) -> Result<W, ExportError> {
    let mut reader = csv::Reader::from_reader(table);
    let names: Vec<String> = reader.headers()?.iter().map(str::to_owned).collect();
    let about = |name: &String| columns.iter().find(|about| about.name == *name);
    let kinds: Vec<Kind> = names.iter().map(|name| about(name).map_or(Kind::Text, |it| it.kind)).collect();
    let properties = WriterProperties::builder()
        .set_created_by(format!("usar {}", env!("CARGO_PKG_VERSION")))
        .set_compression(Compression::SNAPPY)
        .build();
    let mut writer = SerializedFileWriter::new(out, schema(&names, &kinds)?, Arc::new(properties))?;
    let mut records = reader.into_records().peekable();
    let case = names.iter().position(|name| name == CASE);
    let mut first_row = 0;
    loop {
        let rows = next_group(&mut records, case)?;
        if rows.is_empty() {
            return Ok(writer.into_inner()?);
        }
        let mut group = writer.next_row_group()?;
        for (place, (name, kind)) in names.iter().zip(&kinds).enumerate() {
            let cells = rows.iter().map(|row| row.get(place).unwrap_or_default());
            let column = group.next_column()?;
            let Some(column) = column else { break };
            write_column(column, *kind, cells).map_err(|failure| failure.at(first_row, name))?;
        }
        group.close()?;
        first_row += rows.len();
    }
}

/// The rows of the next row group. If the table has cases, they belong to one case, so that a reader can
/// skip the other cases.
fn next_group(
    records: &mut std::iter::Peekable<impl Iterator<Item = csv::Result<csv::StringRecord>>>,
    case: Option<usize>,
) -> Result<Vec<csv::StringRecord>, ExportError> {
    let mut rows: Vec<csv::StringRecord> = Vec::new();
    let case_of = |row: &csv::StringRecord| case.and_then(|case| row.get(case).map(str::to_owned));
    while rows.len() < ROWS {
        let fits = |next: &csv::Result<csv::StringRecord>| match (next, rows.first()) {
            (Ok(next), Some(first)) => case_of(next) == case_of(first),
            _ => true,
        };
        let Some(row) = records.next_if(fits) else { break };
        rows.push(row?);
    }
    Ok(rows)
}

fn schema(names: &[String], kinds: &[Kind]) -> Result<Arc<Type>, ExportError> {
    let field = |(name, kind): (&String, &Kind)| {
        let (physical, logical) = match kind {
            Kind::Natural => (Physical::INT64, Some(LogicalType::integer(64, false))),
            Kind::Number => (Physical::DOUBLE, None),
            Kind::Truth => (Physical::BOOLEAN, None),
            Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let converted = match kind {
            Kind::Natural => ConvertedType::UINT_64,
            Kind::Text => ConvertedType::UTF8,
            _ => ConvertedType::NONE,
        };
        let column = Type::primitive_type_builder(name, physical)
            .with_repetition(Repetition::OPTIONAL)
            .with_logical_type(logical)
            .with_converted_type(converted);
        Ok(Arc::new(column.build()?))
    };
    let fields = names.iter().zip(kinds).map(field).collect::<Result<_, ExportError>>()?;
    Ok(Arc::new(Type::group_type_builder("table").with_fields(fields).build()?))
}

/// Why a column cannot be written.
enum ColumnFailure {
    Cell { row: usize, rule: &'static str, found: String },
    Other(ExportError),
}

impl ColumnFailure {
    fn at(self, first_row: usize, column: &str) -> ExportError {
        match self {
            Self::Cell { row, rule, found } => {
                ExportError::Cell { row: first_row + row + 1, column: column.to_owned(), rule, found }
            }
            Self::Other(error) => error,
        }
    }
}

impl From<parquet::errors::ParquetError> for ColumnFailure {
    fn from(error: parquet::errors::ParquetError) -> Self {
        Self::Other(error.into())
    }
}

/// The values of the non-empty cells, and for each cell whether it has a value.
fn values<'c, T>(
    cells: impl Iterator<Item = &'c str>,
    rule: &'static str,
    read: impl Fn(&str) -> Option<T>,
) -> Result<(Vec<T>, Vec<i16>), ColumnFailure> {
    let (mut values, mut has_value) = (Vec::new(), Vec::new());
    for (row, cell) in cells.enumerate() {
        has_value.push(i16::from(!cell.is_empty()));
        if !cell.is_empty() {
            let wrong = || ColumnFailure::Cell { row, rule, found: cell.to_owned() };
            values.push(read(cell).ok_or_else(wrong)?);
        }
    }
    Ok((values, has_value))
}

fn write_column<'c>(
    mut column: SerializedColumnWriter<'_>,
    kind: Kind,
    cells: impl Iterator<Item = &'c str>,
) -> Result<(), ColumnFailure> {
    match kind {
        Kind::Natural => {
            let read = |cell: &str| cell.parse().ok().map(u64::cast_signed);
            let (values, has) = values(cells, "a whole number", read)?;
            column.typed::<Int64Type>().write_batch(&values, Some(&has), None)?;
        }
        Kind::Number => {
            let (values, has) = values(cells, "a number", |cell| cell.parse().ok())?;
            column.typed::<DoubleType>().write_batch(&values, Some(&has), None)?;
        }
        Kind::Truth => {
            let (values, has) = values(cells, "true or false", |cell| cell.parse().ok())?;
            column.typed::<BoolType>().write_batch(&values, Some(&has), None)?;
        }
        Kind::Text => {
            let (values, has) = values(cells, "a text", |cell| Some(ByteArray::from(cell)))?;
            column.typed::<ByteArrayType>().write_batch(&values, Some(&has), None)?;
        }
    }
    Ok(column.close()?)
}
