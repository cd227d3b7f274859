//! Checks whether a text is well-formed. Messages use the terms of the text: which bracket is not closed,
//! where a comma is missing.

use thiserror::Error;

use crate::cursor::{Cursor, is_of_name};

/// Largest number of characters of the text that a message quotes.
const MOST_SHOWN: usize = 24;

/// A text that is not well-formed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{message}")]
pub struct SyntaxError {
    /// Byte at which the error is, from the beginning of the text.
    pub at: usize,
    /// Description of the error.
    pub message: String,
}

/// Checks brackets, commas, colons, strings and numbers. Check the limits with
/// [`check_size`](crate::check_size) first, since this function recurses into nested brackets.
///
/// # Errors
/// The first error in the text.
pub fn check_syntax(text: &str) -> Result<(), SyntaxError> {
    let mut reader = Reader { cursor: Cursor::new(text), text, long_string: None };
    reader.blank()?;
    if reader.cursor.peek().is_none() {
        return wrong(0, "has no value: only blanks and comments");
    }
    reader.value("the file")?;
    reader.blank()?;
    if reader.cursor.peek().is_none() {
        return Ok(());
    }
    wrong(reader.cursor.at(), &format!("nothing may follow the end of the value, found {}", reader.here()))
}

struct Reader<'t> {
    cursor: Cursor<'t>,
    text: &'t str,
    /// Byte at which the last string begins that continues beyond its line.
    long_string: Option<usize>,
}

type Checked = Result<(), SyntaxError>;

fn wrong(at: usize, message: &str) -> Checked {
    Err(SyntaxError { at, message: message.to_owned() })
}

impl Reader<'_> {
    /// The beginning of the next part, as a message quotes it.
    fn here(&self) -> String {
        self.shown(self.cursor.at())
    }

    fn shown(&self, at: usize) -> String {
        let rest = self.text.get(at..).unwrap_or_default();
        let is_end = |c: char| c.is_whitespace() || ",:()[]{}".contains(c);
        let first = rest.chars().next().map_or(0, char::len_utf8);
        let end = rest.get(first..).and_then(|rest| rest.find(is_end)).map_or(rest.len(), |end| end + first);
        let shown: String = rest.get(..end).unwrap_or(rest).chars().take(MOST_SHOWN).collect();
        if shown.is_empty() { "the end of the file".to_owned() } else { format!("`{shown}`") }
    }

    fn line_of(&self, at: usize) -> usize {
        1 + self.text.get(..at).unwrap_or_default().matches('\n').count()
    }

    /// Reads blanks and comments; an unclosed comment is an error.
    fn blank(&mut self) -> Checked {
        let start = self.cursor.at();
        self.cursor.skip_blank();
        let skipped = self.cursor.since(start);
        if self.cursor.peek().is_none() && skipped.contains("/*") && !skipped.trim_end().ends_with("*/") {
            let is_line = skipped.rsplit('\n').next().is_some_and(|last| last.contains("//"));
            let at = start + skipped.rfind("/*").unwrap_or_default();
            return if is_line { Ok(()) } else { wrong(at, "the comment `/*` is not closed by `*/`") };
        }
        Ok(())
    }

    /// Reads a value; `what` describes its owner in messages.
    fn value(&mut self, what: &str) -> Checked {
        self.blank()?;
        let at = self.cursor.at();
        match self.cursor.peek() {
            Some(b'(') => self.entries(b')'),
            Some(b'[') => self.entries(b']'),
            Some(b'{') => self.entries(b'}'),
            Some(b'"') => self.string(),
            Some(b'\'') => self.character(),
            Some(b'#') => {
                wrong(at, "extensions change what a file means and are not allowed; remove `#![...]`")
            }
            Some(byte) if is_of_name(byte) && !byte.is_ascii_digit() => self.named(),
            Some(byte) if byte.is_ascii_digit() || b"+-.".contains(&byte) => self.number(),
            _ => {
                let found = self.here();
                wrong(at, &format!("a value is missing: {what} must have one, found {found}"))
            }
        }
    }

    fn string(&mut self) -> Checked {
        let at = self.cursor.at();
        self.cursor.quoted(b'"');
        let text = self.cursor.since(at);
        if text.len() < 2 || !text.ends_with('"') || ends_escaped(text) {
            return wrong(self.long_string.unwrap_or(at), "the string is not closed by `\"`");
        }
        if text.contains('\n') {
            self.long_string = self.long_string.or(Some(at));
        }
        Ok(())
    }

    fn character(&mut self) -> Checked {
        wrong(self.cursor.at(), "texts are written in double quotes: \"...\"")
    }

    /// Reads a name, alone or before brackets, or a string with a prefix.
    fn named(&mut self) -> Checked {
        let at = self.cursor.at();
        let name = self.cursor.identifier();
        if matches!((name, self.cursor.peek()), ("r", Some(b'"' | b'#'))) {
            self.cursor.raw_string();
            return if self.cursor.peek().is_none() { wrong(at, "the string is not closed") } else { Ok(()) };
        }
        if name.contains(['“', '”', '„', '‘', '’', '«', '»']) {
            return wrong(at, "texts are written in straight quotes: \"...\"");
        }
        if matches!(name, "inf" | "NaN") || name.is_ascii() {
            let end = self.cursor.at();
            self.blank()?;
            if self.cursor.peek() == Some(b'(') {
                return self.entries(b')');
            }
            self.cursor.go_back(end);
            return Ok(());
        }
        wrong(at, &format!("{} is no value: numbers, \"texts\", names and brackets are", self.shown(at)))
    }

    fn number(&mut self) -> Checked {
        let at = self.cursor.at();
        self.cursor.word();
        let word = self.cursor.since(at);
        let word = word.split([';', '=', ':']).next().unwrap_or_default();
        self.cursor.go_back(at + word.len());
        let digits = word.trim_start_matches(['+', '-']);
        let is_number = word.len() <= digits.len() + 1
            && !digits.ends_with('_')
            && (matches!(digits, "inf" | "NaN")
                || digits.replace('_', "").parse::<f64>().is_ok() && !digits.contains("nan"));
        let is_other_base = ["0x", "0b", "0o"].iter().any(|start| digits.starts_with(start));
        if is_number || is_other_base {
            return Ok(());
        }
        let number = digits.trim_end_matches(|c: char| c.is_alphabetic() || "%²°/".contains(c));
        let message = if number.len() < digits.len() && number.parse::<f64>().is_ok() {
            format!("a number is written without its unit, found {}", self.shown(at))
        } else {
            format!("{} is no number", self.shown(at))
        };
        wrong(at, &message)
    }

    /// Reads the content of brackets, including the closing bracket.
    fn entries(&mut self, close: u8) -> Checked {
        let open_at = self.cursor.at();
        self.cursor.advance();
        let mut is_named = None;
        loop {
            self.blank()?;
            match self.cursor.peek() {
                Some(byte) if byte == close => {
                    self.cursor.advance();
                    return Ok(());
                }
                Some(b')' | b']' | b'}') | None => return self.not_closed(open_at, close),
                Some(b',') => return wrong(self.cursor.at(), "an entry is missing before `,`"),
                Some(_) => self.entry(close, &mut is_named)?,
            }
            let end = self.cursor.at();
            self.blank()?;
            match self.cursor.peek() {
                Some(b',') => self.cursor.advance(),
                Some(b')' | b']' | b'}') | None => {}
                Some(_) => return self.no_comma(end),
            }
        }
    }

    fn not_closed(&self, open_at: usize, close: u8) -> Checked {
        let (open, line) = (&self.text[open_at..=open_at], self.line_of(open_at));
        let found = self.here();
        let close = close as char;
        wrong(
            self.cursor.at(),
            &format!("`{open}` of line {line} is not closed: `{close}` is missing, found {found}"),
        )
    }

    fn no_comma(&self, end: usize) -> Checked {
        let found = self.here();
        if let Some(at) = self.long_string {
            return wrong(at, "the string is not closed on its line by `\"`");
        }
        let word = found.trim_matches('`');
        let after =
            self.text[self.cursor.at() + word.len().min(self.text.len() - self.cursor.at())..].trim_start();
        let is_unit = word.len() <= 4 && word.chars().all(char::is_alphabetic) && !after.starts_with(':');
        if is_unit && self.text[..end].ends_with(|c: char| c.is_ascii_digit()) {
            return wrong(self.cursor.at(), &format!("a number is written without its unit, found {found}"));
        }
        let message = match self.cursor.peek() {
            Some(b'=') => "a field is written with a colon, as in `name: value`, found `=`".to_owned(),
            Some(b';') => "entries are separated by commas, found `;`".to_owned(),
            Some(b':') => {
                "found `:` after a value: a comma is missing before the field, or the name of the field"
                    .to_owned()
            }
            _ => format!("a comma is missing before {found}"),
        };
        let at = if message.starts_with("a comma") { end } else { self.cursor.at() };
        wrong(at, &message)
    }

    /// Reads a field with its name, or an entry without one. Within one pair of round brackets, all are of
    /// one kind.
    fn entry(&mut self, close: u8, is_named: &mut Option<bool>) -> Checked {
        let at = self.cursor.at();
        if close == b']' {
            return self.value("the list's entry");
        }
        let name = if self.cursor.peek() == Some(b'"') {
            self.string()?;
            self.cursor.since(at)
        } else {
            self.cursor.identifier()
        };
        let (name_end, is_name) =
            (self.cursor.at(), !name.is_empty() && !name.starts_with(|c: char| c.is_ascii_digit()));
        self.blank()?;
        if is_name && self.cursor.peek() == Some(b':') {
            if *is_named == Some(false) {
                return wrong(
                    at,
                    &format!("{} has a name, which the entries before it have not", self.shown(at)),
                );
            }
            *is_named = Some(true);
            self.cursor.advance();
            return self.value(&format!("`{name}`"));
        }
        if *is_named == Some(true) || close == b'}' {
            let message = match self.cursor.peek() {
                Some(b'=') => format!("a field is written with a colon, as in `{name}: value`, found `=`"),
                _ if is_name => format!("`:` is missing after {}", self.shown(at)),
                _ => {
                    let is_decimal = self.text[..at].ends_with(',')
                        && self.text[at..].starts_with(|c: char| c.is_ascii_digit());
                    let point = if is_decimal { "; decimals are written with a point" } else { "" };
                    format!("the name of a field is missing before {}{point}", self.shown(at))
                }
            };
            return wrong(if is_name { name_end } else { at }, &message);
        }
        *is_named = Some(false);
        self.cursor.go_back(at);
        self.value("the entry")
    }
}

/// Whether the last quote of a string is escaped and therefore does not close the string.
fn ends_escaped(text: &str) -> bool {
    let before = &text.as_bytes()[..text.len() - 1];
    before.iter().rev().take_while(|byte| **byte == b'\\').count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_is_told_in_words_of_the_text() {
        for (text, at, message) in [
            ("(a: 1", 5, "`(` of line 1 is not closed: `)` is missing, found the end of the file"),
            ("(a: [1, 2\n)", 10, "`[` of line 1 is not closed: `]` is missing, found `)`"),
            ("(a: 1 b: 2)", 5, "a comma is missing before `b`"),
            ("(a: 1, b 2)", 8, "`:` is missing after `b`"),
            ("(a: 1, 2)", 7, "the name of a field is missing before `2`"),
            ("(1, a: 2)", 4, "`a` has a name, which the entries before it have not"),
            ("(a: , b: 2)", 4, "a value is missing: `a` must have one, found `,`"),
            ("(a: )", 4, "a value is missing: `a` must have one, found `)`"),
            ("(a = 1)", 3, "a field is written with a colon, as in `name: value`, found `=`"),
            ("(b: 1, a = 1)", 8, "a field is written with a colon, as in `a: value`, found `=`"),
            ("(a: 1; b: 2)", 5, "entries are separated by commas, found `;`"),
            ("(a: 1,, b: 2)", 6, "an entry is missing before `,`"),
            ("(a: \"x)", 4, "the string is not closed by `\"`"),
            ("(a: \"x\\\")", 4, "the string is not closed by `\"`"),
            ("(a: 'x')", 4, "texts are written in double quotes: \"...\""),
            ("(a: “x”)", 4, "texts are written in straight quotes: \"...\""),
            ("(a: 10m)", 4, "a number is written without its unit, found `10m`"),
            ("(a: 1.2.3)", 4, "`1.2.3` is no number"),
            ("(a: 1)) ", 6, "nothing may follow the end of the value, found `)`"),
            ("(a: 1) b", 7, "nothing may follow the end of the value, found `b`"),
            ("(a: 1 /* no end", 6, "the comment `/*` is not closed by `*/`"),
            ("// nothing", 0, "has no value: only blanks and comments"),
            ("{\"a\" 1}", 4, "`:` is missing after `\"a\"`"),
        ] {
            let error = check_syntax(text).expect_err(text);
            assert_eq!((error.at, error.message.as_str()), (at, message), "{text}");
        }
    }

    #[test]
    fn what_is_well_formed_passes() {
        for text in [
            "()",
            "(a: 1, b: [1, 2.5, -3e4, +1, .5, 1_000, 0x1F, inf, -inf, NaN], c: (1, 2), d: \"x\\\\\", e: \
             r#\"a\"b\"#,)",
            "Named(a: Some(1), b: Unit, c: Tuple(1, 2), d: {\"a\": 1, \"b\": [],}, e: (), f: true) // end",
            "/* a /* nested */ comment */ [(), [],]",
            "// first\n(a: 1 /* in */, // after\n)\n/* last */",
            "(a: 1) // the last line /* has this",
        ] {
            assert_eq!(check_syntax(text), Ok(()), "{text}");
        }
    }

    #[test]
    fn no_text_leads_astray() {
        for text in [
            "",
            "(",
            ")",
            "\"",
            "'",
            "r#\"",
            "#![",
            "(a:",
            "(a",
            "[",
            "{",
            "{1",
            "\u{feff}()",
            "(日: 日)",
            "Some(",
            "-",
            "(\\)",
        ] {
            assert!(check_syntax(text).is_err(), "{text}");
        }
    }
}
