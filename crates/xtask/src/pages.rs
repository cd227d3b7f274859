//! Pages of `docs/` hold the output of commands. The block after the line `<!-- $ usar ... -->` is the
//! output of that command. `<!-- $ usar ... | TITLE -->` selects a part of it: the table below the line
//! that begins with this title, as Markdown, or the paragraph that begins with it, as a block. A number
//! selects the first, second, ... table. A table that is too long for a page is a CSV beside it:
//! `<!-- $ usar ... | TITLE > FILE -->`; the title `comparisons` takes all that `usar compare` compares.

use std::path::Path;
use std::process::Command;

use crate::verdicts::comparisons;

/// Start of the line before a block.
pub const MARK: &str = "<!-- $ usar ";

/// A page's request for output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Request<'p> {
    /// The arguments of `usar`.
    pub command: &'p str,
    /// The title of the table, or the beginning of the paragraph, to select; `None` for the whole output.
    pub table: Option<&'p str>,
    /// The CSV file that takes the table, relative to the page's folder.
    pub file: Option<&'p str>,
}

impl<'p> Request<'p> {
    /// The request in a line of a page, if there is one.
    pub fn of(line: &'p str) -> Option<Self> {
        let asked = line.strip_prefix(MARK)?.strip_suffix(" -->")?;
        let (asked, file) = parts(asked, " > ");
        let (command, table) = parts(asked, " | ");
        Some(Self { command, table, file })
    }

    /// The arguments of the command that answers the request.
    fn arguments(self) -> String {
        let markdown = match self.table {
            Some("comparisons") => " --wide --format md",
            Some(_) => " --format md",
            None => "",
        };
        format!("{}{markdown}", self.command)
    }
}

fn parts<'t>(text: &'t str, sign: &str) -> (&'t str, Option<&'t str>) {
    text.rsplit_once(sign).map_or((text.trim(), None), |(left, right)| (left.trim(), Some(right.trim())))
}

/// A renewed page.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Renewed {
    /// Its text.
    pub page: String,
    /// The CSV files beside it: names and contents.
    pub files: Vec<(String, String)>,
}

/// The page with the block of each command that `run` answers replaced by the answer.
///
/// # Panics
/// The page does not have the expected form, or an answer lacks the table.
pub fn renewed(page: &str, mut run: impl FnMut(&str) -> Option<String>) -> Renewed {
    let mut new = Renewed::default();
    let mut lines = page.split_inclusive('\n').peekable();
    while let Some(line) = lines.next() {
        new.page.push_str(line);
        let Some(request) = Request::of(line.trim_end()) else { continue };
        let Some(answer) = run(&request.arguments()) else { continue };
        let is_block = lines.peek() == Some(&"```text\n");
        match (request.table, request.file) {
            (Some("comparisons"), Some(file)) => new.files.push((file.to_owned(), comparisons(&answer))),
            (Some(title), Some(file)) => new.files.push((file.to_owned(), csv(&table(&answer, title)))),
            (Some(title), None) if !is_block => {
                while lines.next_if(|line| line.starts_with('|')).is_some() {}
                new.page.push_str(&table(&answer, title));
            }
            (title, _) => {
                assert!(is_block, "a block follows {line}");
                assert!(lines.any(|line| line == "```\n"), "the block after {line} ends");
                let text = title.map_or(answer.clone(), |title| paragraph(&answer, title));
                new.page.extend(["```text\n", text.trim_end(), "\n```\n"]);
            }
        }
    }
    new
}

/// The lines of the table below a title, or of the table with this number.
fn table(answer: &str, title: &str) -> String {
    let lines: Vec<&str> = answer.lines().collect();
    let is_row = |i: usize| lines[i].starts_with('|');
    let mut starts = (0..lines.len()).filter(|i| is_row(*i) && !(*i > 0 && is_row(i - 1)));
    let start = if let Ok(number) = title.parse::<usize>() {
        starts.nth(number - 1)
    } else {
        let titled = lines.iter().position(|line| line.starts_with(title));
        titled.and_then(|titled| starts.find(|start| *start > titled && *start <= titled + 2))
    };
    let start = start.unwrap_or_else(|| panic!("no table {title:?} in\n{answer}"));
    lines[start..].iter().take_while(|line| line.starts_with('|')).flat_map(|line| [line, "\n"]).collect()
}

/// The lines from one that begins with `start` up to an empty line.
fn paragraph(answer: &str, start: &str) -> String {
    let lines = answer.lines().skip_while(|line| !line.starts_with(start));
    let lines: Vec<&str> = lines.take_while(|line| !line.is_empty()).collect();
    assert!(!lines.is_empty(), "no line begins with {start:?} in\n{answer}");
    lines.join("\n")
}

/// Converts a Markdown table to CSV.
fn csv(table: &str) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for (i, line) in table.lines().enumerate() {
        let inner = line.trim_start_matches("| ").trim_end_matches(" |");
        if i != 1 {
            writer.write_record(inner.split(" | ").map(|cell| cell.replace("\\|", "|"))).expect("a row");
        }
    }
    String::from_utf8(writer.into_inner().expect("in memory")).expect("text")
}

/// The words of a command; single quotes group words.
fn words(command: &str) -> Vec<&str> {
    let parts = command.split('\'').enumerate();
    parts
        .flat_map(|(i, part)| if i % 2 == 1 { vec![part] } else { part.split_whitespace().collect() })
        .collect()
}

/// The output of `usar`, run in this folder.
///
/// # Panics
/// The command fails.
pub fn answer(usar: &Path, folder: &Path, arguments: &str) -> String {
    let output = Command::new(usar).args(words(arguments)).current_dir(folder).output();
    let output = output.expect("usar runs");
    assert!(output.status.success(), "usar {arguments}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}
