//! What a verb tells, in blocks, and the one place where it is printed: sentences and tables to the terminal,
//! or tables or JSON for other programs.

use std::io::{self, Write};

use experiments::Failure;
use serde::Serialize;
use tables::{Table, shown_as};
use terminal_size::{Height, Width, terminal_size_of};

use crate::printable::Printable;

/// Version of the JSON that the commands print.
const SCHEMA_VERSION: u32 = 1;

/// What a verb tells, in its order.
#[derive(Default)]
pub struct Report(Vec<Block>);

/// A part of a report.
enum Block {
    /// Whole lines for people.
    Sentence(String),
    Table(Table),
    /// An object for other programs.
    Json(String),
}

impl<T: Into<String>> From<T> for Report {
    fn from(sentence: T) -> Self {
        Self::of([sentence])
    }
}

impl Report {
    /// A report of sentences.
    pub fn of(sentences: impl IntoIterator<Item: Into<String>>) -> Self {
        let mut report = Self::default();
        report.extend(sentences);
        report
    }

    /// An object as a line of JSON, with the version of its layout.
    ///
    /// # Errors
    /// The object cannot be JSON.
    pub fn json(object: &impl Serialize) -> Result<Self, Failure> {
        Self::plain_json(&Versioned { schema_version: SCHEMA_VERSION, object })
    }

    /// The same for an object that has a version of its own.
    ///
    /// # Errors
    /// The object cannot be JSON.
    pub fn plain_json(object: &impl Serialize) -> Result<Self, Failure> {
        Ok(Self(vec![Block::Json(serde_json::to_string(object).map_err(Failure::run)?)]))
    }

    /// Adds a sentence: whole lines, without the last line break.
    pub fn say(&mut self, sentence: impl Into<String>) {
        self.0.push(Block::Sentence(sentence.into()));
    }

    /// Adds sentences.
    pub fn extend(&mut self, sentences: impl IntoIterator<Item: Into<String>>) {
        sentences.into_iter().for_each(|sentence| self.say(sentence));
    }

    /// Adds a table.
    pub fn show(&mut self, table: Table) {
        self.0.push(Block::Table(table));
    }

    /// Adds a table below its title.
    pub fn titled(&mut self, title: impl Into<String>, table: Table) {
        self.say(title);
        self.show(table);
    }

    /// Prints the report. A verb that goes on after it has told something prints that itself.
    ///
    /// # Errors
    /// The output takes no more.
    pub fn print(self) -> Result<(), Failure> {
        let format = shown_as();
        let mut out = sentences();
        let plain = || Printable::new(io::stdout().lock());
        for block in self.0 {
            match block {
                Block::Sentence(text) => writeln!(out, "{text}")?,
                Block::Table(table) if format.is_for_programs() => {
                    plain().write_all(format.write(&table)?.as_bytes())?;
                }
                Block::Table(table) => out.write_all(format.write(&table)?.as_bytes())?,
                Block::Json(text) => writeln!(plain(), "{text}")?,
            }
        }
        Ok(out.flush()?)
    }
}

/// An object, and the version of its layout.
#[derive(Serialize)]
struct Versioned<'o, O> {
    schema_version: u32,
    #[serde(flatten)]
    object: &'o O,
}

/// The destination of sentences: stdout, or stderr if stdout is for other programs.
pub(crate) fn sentences() -> Box<dyn Write> {
    if shown_as().is_for_programs() {
        Box::new(Printable::new(io::stderr()).with_columns(columns_of(terminal_size_of(io::stderr()))))
    } else {
        Box::new(Printable::new(io::stdout().lock()).with_columns(columns_of(terminal_size_of(io::stdout()))))
    }
}

/// Columns of a terminal of this size, or of the variable `COLUMNS`; `None` for neither.
pub(crate) fn columns_of(terminal: Option<(Width, Height)>) -> Option<u16> {
    let of_terminal = terminal.map(|(Width(columns), _)| columns);
    of_terminal.or_else(|| std::env::var("COLUMNS").ok()?.parse().ok()).filter(|columns| *columns > 0)
}
