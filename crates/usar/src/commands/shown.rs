//! The output formats of a command's tables.

use std::io::Write;

use clap::{Args, ValueEnum};
use experiments::Failure;
use reports::table::{Format, Table, shown_as};

use crate::printable::Printable;

/// How tables are written.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct ShownArguments {
    /// How tables are written; with csv, latex and json, only tables go to stdout, and sentences to stderr
    #[arg(long, value_enum, default_value = "table")]
    format: FormatName,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum FormatName {
    Table,
    Md,
    Csv,
    Latex,
    Json,
}

impl ShownArguments {
    /// The format of tables.
    pub(crate) fn format(self) -> Format {
        match self.format {
            FormatName::Table => Format::Table,
            FormatName::Md => Format::Markdown,
            FormatName::Csv => Format::Csv,
            FormatName::Latex => Format::Latex,
            FormatName::Json => Format::Json,
        }
    }

    /// Whether JSON is selected. For commands that have `--json`, both mean the same.
    pub(crate) fn is_json(self) -> bool {
        self.format() == Format::Json
    }
}

/// The destination of sentences: stdout, or stderr if stdout is for other programs. A command with
/// `has_json` writes its own JSON.
pub(crate) fn sentences(format: Format, has_json: bool) -> Box<dyn Write> {
    if format.is_for_programs() && !(has_json && format == Format::Json) {
        Box::new(Printable::new(std::io::stderr()))
    } else {
        Box::new(Printable::new(std::io::stdout().lock()))
    }
}

/// Writes a table in the selected format. All tables of the program are written here.
pub(super) fn print_table(out: &mut dyn Write, table: &Table) -> Result<(), Failure> {
    let format = shown_as();
    let text = format.write(table)?;
    if !format.is_for_programs() {
        return Ok(out.write_all(text.as_bytes())?);
    }
    let mut stdout = Printable::new(std::io::stdout().lock());
    Ok(stdout.write_all(text.as_bytes())?)
}
