//! What a verb tells, in blocks, and the one place where it is printed: sentences and tables to the terminal,
//! tables for other programs, or all of it as one object of JSON.

use std::io::{self, Write};

use experiments::Failure;
use serde::Serialize;
use serde_json::json;
use tables::{Format, Table, shown_as};
use terminal_size::{Height, Width, terminal_size_of};

use crate::printable::Printable;

/// Version of the JSON that the commands print.
const VERSION: u32 = 2;

/// What a verb tells, in its order.
#[derive(Default)]
pub struct Report(Vec<Block>);

/// A part of a report.
enum Block {
    /// Whole lines for people.
    Sentence(String),
    /// A table by its name.
    Table(String, Table),
    /// The rows of the table of this name as objects of JSON.
    Rows(String, Vec<String>),
    /// An object that has a layout of its own.
    Document(String),
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

    /// An object as a line of JSON, for one that has a layout and a version of its own.
    ///
    /// # Errors
    /// The object cannot be JSON.
    pub fn document(object: &impl Serialize) -> Result<Self, Failure> {
        Ok(Self(vec![Block::Document(serde_json::to_string(object).map_err(Failure::run)?)]))
    }

    /// Adds a sentence: whole lines, without the last line break.
    pub fn say(&mut self, sentence: impl Into<String>) {
        self.0.push(Block::Sentence(sentence.into()));
    }

    /// Adds sentences.
    pub fn extend(&mut self, sentences: impl IntoIterator<Item: Into<String>>) {
        sentences.into_iter().for_each(|sentence| self.say(sentence));
    }

    /// Adds a table. In JSON, tables of the same name are one.
    pub fn show(&mut self, name: impl Into<String>, table: Table) {
        self.0.push(Block::Table(name.into(), table));
    }

    /// What a table is made of: in JSON these rows take the place of the tables of this name, and no other
    /// form shows them.
    ///
    /// # Errors
    /// A row cannot be JSON.
    pub fn rows<'r, T: Serialize + 'r>(
        &mut self,
        name: &str,
        rows: impl IntoIterator<Item = &'r T>,
    ) -> Result<(), Failure> {
        if shown_as() == Format::Json {
            let rows = rows.into_iter().map(serde_json::to_string).collect::<Result<_, _>>();
            self.0.push(Block::Rows(name.to_owned(), rows.map_err(Failure::run)?));
        }
        Ok(())
    }

    /// Prints the report. A verb that goes on after it has told something prints that itself.
    ///
    /// # Errors
    /// The output takes no more.
    pub fn print(self) -> Result<(), Failure> {
        let format = shown_as();
        if format == Format::Json {
            return self.print_json();
        }
        let mut out = sentences();
        let plain = || Printable::new(io::stdout().lock());
        for block in self.0 {
            match block {
                Block::Sentence(text) => writeln!(out, "{text}")?,
                Block::Table(_, table) if format.is_for_programs() => {
                    plain().write_all(format.write(&table)?.as_bytes())?;
                }
                Block::Table(_, table) => out.write_all(format.write(&table)?.as_bytes())?,
                Block::Document(text) => writeln!(plain(), "{text}")?,
                Block::Rows(..) => {}
            }
        }
        Ok(out.flush()?)
    }

    /// Prints the report as one object; nothing if there is nothing to tell.
    fn print_json(self) -> Result<(), Failure> {
        let replaced: Vec<String> = self.0.iter().filter_map(Block::replaced).collect();
        let (mut sentences, mut tables) = (Vec::new(), Vec::<(String, Vec<String>)>::new());
        let is_empty = self.0.is_empty();
        for block in self.0 {
            let (name, rows) = match block {
                Block::Document(text) => return Ok(writeln!(Printable::new(io::stdout().lock()), "{text}")?),
                Block::Sentence(text) => {
                    sentences
                        .extend(Some(text.trim_matches('\n').to_owned()).filter(|text| !text.is_empty()));
                    continue;
                }
                Block::Table(name, _) if replaced.contains(&name) => continue,
                Block::Table(name, table) => (name, table.objects()?),
                Block::Rows(name, rows) => (name, rows),
            };
            match tables.iter_mut().find(|(known, _)| *known == name) {
                Some((_, known)) => known.extend(rows),
                None => tables.push((name, rows)),
            }
        }
        if is_empty {
            return Ok(());
        }
        let table = |(name, rows): &(String, Vec<String>)| format!("{}:[{}]", json!(name), rows.join(","));
        let tables = tables.iter().map(table).collect::<Vec<_>>().join(",");
        let (sentences, mut out) = (json!(sentences), Printable::new(io::stdout().lock()));
        Ok(writeln!(out, "{{\"version\":{VERSION},\"sentences\":{sentences},\"tables\":{{{tables}}}}}")?)
    }
}

impl Block {
    /// The name of the tables whose place these rows take.
    fn replaced(&self) -> Option<String> {
        if let Self::Rows(name, _) = self { Some(name.clone()) } else { None }
    }
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
