//! A table for people who look up its columns.

use std::fmt::Write;

use crate::column::About;

/// The section of a page in Markdown about a table: its file, what a row is, and its columns.
pub fn section(file: &str, row: &str, columns: &[About]) -> String {
    let mut text = format!(
        "\n## {file}\n\nA row is {row}.\n\n| column | type | unit | meaning |\n| --- | --- | --- | --- |\n"
    );
    for About { name, kind, unit, meaning } in columns {
        let cell = |text: &str| text.replace('|', "\\|");
        let _ = writeln!(text, "| `{}` | {} | {unit} | {} |", cell(name), kind.name(), cell(meaning));
    }
    text
}
