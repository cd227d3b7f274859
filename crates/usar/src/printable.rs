//! Makes text safe to print, and as wide as the terminal: no character of it can control the terminal, and
//! sentences fold between words.

use std::io::{self, Write};

use ron_tree::visible;
use textwrap::{Options, WordSplitter};

/// A number of things: `1 case`, `2 cases`, `3 policies`.
pub fn counted(count: usize, thing: &str) -> String {
    match thing.strip_suffix('y') {
        _ if count == 1 => format!("1 {thing}"),
        Some(stem) => format!("{count} {stem}ies"),
        None => format!("{count} {thing}s"),
    }
}

/// How the lines begin that are shown of a file.
const EXCERPT: &str = "    ";

/// A line that is folded between words, and begins further in where it goes on: below the second column, if
/// it has columns. Lines of tables stay as they are, and so do lines of files, which have a caret below them.
pub(crate) fn folded(line: &str, columns: usize) -> String {
    let is_kept = line.starts_with(['│', '┌', '╞', '└', '├']) || line.starts_with(EXCERPT);
    if is_kept || textwrap::core::display_width(line) <= columns {
        return line.to_owned();
    }
    let words = line.trim_start();
    let begin = line.len() - words.len();
    let gap = words.find("  ").map(|gap| gap + words[gap..].len() - words[gap..].trim_start().len());
    let after_tab = if line.contains('\t') { 4 } else { 0 };
    let indent = begin + gap.filter(|gap| begin + gap < columns / 2).unwrap_or(after_tab);
    let spaces = " ".repeat(indent);
    let options = Options::new(columns)
        .break_words(false)
        .word_splitter(WordSplitter::NoHyphenation)
        .subsequent_indent(&spaces);
    textwrap::fill(line, options)
}

/// Passes text on with every character [`visible`], and sentences after they are [`folded`].
pub(crate) struct Printable<W> {
    to: W,
    /// Columns of the terminal; `None` for what is not read there.
    columns: Option<usize>,
    /// Bytes of an incomplete character, or, where lines are folded, of an incomplete line.
    begun: Vec<u8>,
}

impl<W: Write> Printable<W> {
    pub(crate) fn new(to: W) -> Self {
        Self { to, columns: None, begun: Vec::new() }
    }

    /// For sentences in a terminal with so many columns.
    pub(crate) fn with_columns(self, columns: Option<u16>) -> Self {
        Self { columns: columns.map(usize::from), ..self }
    }

    /// Passes on what is whole: characters, or lines.
    fn pass_on(&mut self, is_last: bool) -> io::Result<()> {
        let valid = match std::str::from_utf8(&self.begun) {
            Ok(text) => text.len(),
            Err(error) if error.error_len().is_none() => error.valid_up_to(),
            Err(_) => return Err(io::Error::new(io::ErrorKind::InvalidData, "is not text")),
        };
        let text = std::str::from_utf8(&self.begun[..valid]).unwrap_or_default();
        let whole = match self.columns {
            Some(_) if !is_last => text.rfind('\n').map_or(0, |end| end + 1),
            _ => text.len(),
        };
        for line in text[..whole].split_inclusive('\n') {
            let line = visible(line);
            match self.columns {
                Some(columns) => self.to.write_all(folded(&line, columns).as_bytes())?,
                None => self.to.write_all(line.as_bytes())?,
            }
        }
        self.begun.drain(..whole);
        Ok(())
    }
}

impl<W: Write> Write for Printable<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.begun.extend_from_slice(bytes);
        self.pass_on(false)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.pass_on(true)?;
        self.to.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_commands_a_terminal_comes_through() {
        let mut out = Printable::new(Vec::new());
        let text = "a\u{1b}]0;title\u{7}b\r\u{9b}2J\u{202e}c ± ü\tθ\n";
        for byte in text.as_bytes() {
            out.write_all(&[*byte]).unwrap();
        }
        let shown = String::from_utf8(out.to).unwrap();
        assert_eq!(shown, "a\\u{1b}]0;title\\u{7}b\\u{d}\\u{9b}2J\\u{202e}c ± ü\tθ\n");
    }

    #[test]
    fn sentences_fold_between_words_and_tables_stay() {
        let mut out = Printable::new(Vec::new()).with_columns(Some(20));
        out.write_all("one two three four-five six\nrescued  220 (hard 114, easy 106)\n".as_bytes()).unwrap();
        out.write_all("│ a table is never folded │\n    nor is a line of a file\nunfinished".as_bytes())
            .unwrap();
        out.flush().unwrap();
        let expected = "one two three\nfour-five six\nrescued  220 (hard\n         114, easy\n         106)\n\
                        │ a table is never folded │\n    nor is a line of a file\nunfinished";
        assert_eq!(String::from_utf8(out.to).unwrap(), expected);
    }
}
