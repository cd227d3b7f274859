//! Makes text from files and arguments safe to print: no character of it can control the terminal.

use std::borrow::Cow;
use std::io::{self, Write};

/// Whether a character would control a terminal, or change the direction in which text is read.
fn is_command(c: char) -> bool {
    let turns = matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    (c.is_control() && c != '\n' && c != '\t') || turns
}

/// The text with every such character replaced by its number, for example `\u{1b}`.
pub(crate) fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(is_command) {
        return Cow::Borrowed(text);
    }
    let escaped = |c: char| if is_command(c) { format!("\\u{{{:x}}}", c as u32) } else { c.to_string() };
    Cow::Owned(text.chars().map(escaped).collect())
}

/// A number of things: `1 case`, `2 cases`, `3 policies`.
pub(crate) fn counted(count: usize, thing: &str) -> String {
    match thing.strip_suffix('y') {
        _ if count == 1 => format!("1 {thing}"),
        Some(stem) => format!("{count} {stem}ies"),
        None => format!("{count} {thing}s"),
    }
}

/// Passes text on after making it [`printable`].
pub(crate) struct Printable<W> {
    to: W,
    /// Bytes of an incomplete character.
    begun: Vec<u8>,
}

impl<W: Write> Printable<W> {
    pub(crate) fn new(to: W) -> Self {
        Self { to, begun: Vec::new() }
    }
}

impl<W: Write> Write for Printable<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.begun.extend_from_slice(bytes);
        let text = match std::str::from_utf8(&self.begun) {
            Ok(text) => text,
            Err(error) if error.error_len().is_none() => {
                std::str::from_utf8(&self.begun[..error.valid_up_to()]).unwrap_or_default()
            }
            Err(_) => return Err(io::Error::new(io::ErrorKind::InvalidData, "is not text")),
        };
        let whole = text.len();
        self.to.write_all(printable(text).as_bytes())?;
        self.begun.drain(..whole);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
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
}
