//! `docs/limits.md`, made from the constants that define the limits.

use std::fmt::Write;
use std::path::PathBuf;

use ron_tree::limits::Limit;

use crate::docs::{on_a_line, place};

const HEAD: &str = "\
# Limits

What a file may say, and how much of it. Each limit is checked before anything is built: a file that goes
beyond one is refused with its line and field, in less than 100 ms and with less than 110 MB of memory. Only
regular files are read: no folder, no pipe, no device.

The constants are the source of this page: `cargo run --bin xtask -- reference` makes it, and a test compares
it with them. `*` stands for any entry.
";

/// Path of the page.
pub fn path() -> PathBuf {
    place("docs/limits.md")
}

/// Text of the page.
pub fn page() -> String {
    let mut page = HEAD.to_owned();
    for (title, file, limits) in [
        ("Texts", "crates/ron-tree/src/limits.rs", ron_tree::limits::ALL),
        ("Scenarios", "crates/scenario/src/limits.rs", scenario::limits::ALL),
        ("Sweeps, tables and results", "crates/experiments/src/limits.rs", experiments::limits::ALL),
    ] {
        let _ = write!(
            page,
            "\n## {title}\n\n`{file}`\n\n| of | from | to | what |\n| --- | ---: | ---: | --- |\n"
        );
        for Limit { of, least, most, what } in limits {
            let _ =
                writeln!(page, "| `{of}` | {} | {} | {} |", number(*least), number(*most), on_a_line(what));
        }
    }
    page
}

/// A number with commas between thousands.
fn number(value: f64) -> String {
    let text = value.abs().to_string();
    let (whole, rest) = text
        .split_once('.')
        .map_or((text.as_str(), String::new()), |(whole, rest)| (whole, format!(".{rest}")));
    let digits = whole.char_indices().map(|(i, digit)| {
        if i > 0 && (whole.len() - i).is_multiple_of(3) { format!(",{digit}") } else { digit.to_string() }
    });
    let sign = if value < 0.0 { "-" } else { "" };
    format!("{sign}{}{rest}", digits.collect::<String>())
}
