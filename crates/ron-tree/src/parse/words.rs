//! Strings and numbers.

use super::{Part, Reader, Wrong, wrong};
use crate::limits::STRING_BYTES;
use crate::node::Value;

impl Reader<'_> {
    /// Reads `"..."`.
    pub(super) fn string(&mut self) -> Result<Box<str>, Wrong> {
        let start = self.at;
        self.at += 1;
        loop {
            self.skip_while(|byte| byte != b'"' && byte != b'\\');
            match self.peek() {
                Some(b'"') => break,
                Some(_) if self.at + 1 < self.text.len() => self.at += 2,
                _ => {
                    return wrong(self.long_string.unwrap_or(start), "the string is not closed by `\"`");
                }
            }
        }
        self.at += 1;
        self.token(Part::Word, start);
        let text = self.since(start);
        Self::check(start, text.len(), STRING_BYTES, "bytes in a string or a name")?;
        if text.contains('\n') {
            self.long_string = self.long_string.or(Some(start));
        }
        unescaped(&text[1..text.len() - 1], start + 1)
    }

    /// Reads the rest of `r#"..."#` after the `r`.
    pub(super) fn raw_string(&mut self, start: usize) -> Result<Value, Wrong> {
        let hashes = self.rest().iter().take_while(|byte| **byte == b'#').count();
        let end = format!("\"{}", "#".repeat(hashes));
        self.at += hashes + 1;
        let inside = self.text.get(self.at..).unwrap_or_default();
        let Some(length) = inside.find(&end) else { return wrong(start, "the string is not closed") };
        self.at += length + end.len();
        self.token(Part::Word, start);
        Self::check(start, self.at - start, STRING_BYTES, "bytes in a string or a name")?;
        Ok(Value::Text(inside[..length].into()))
    }

    pub(super) fn number(&mut self) -> Result<Value, Wrong> {
        let start = self.at;
        self.skip_while(|byte| !b",)]};=:".contains(&byte) && !byte.is_ascii_whitespace());
        // A comment may follow directly.
        let word = self.since(start);
        let word = word.split("//").next().and_then(|word| word.split("/*").next()).unwrap_or_default();
        self.at = start + word.len();
        let digits = word.trim_start_matches(['+', '-']);
        let is_number = word.len() <= digits.len() + 1 && is_number(digits);
        let is_other_base = ["0x", "0b", "0o"].iter().any(|start| digits.starts_with(start));
        if is_number || is_other_base {
            self.token(Part::Word, start);
            return Ok(Value::Word(word.into()));
        }
        let number = digits.trim_end_matches(|c: char| c.is_alphabetic() || "%²°/".contains(c));
        if number.len() < digits.len() && number.parse::<f64>().is_ok() {
            return wrong(
                start,
                format!("a number is written without its unit, found {}", self.shown(start)),
            );
        }
        wrong(start, format!("{} is no number", self.shown(start)))
    }
}

/// Whether a word without its sign is a number.
pub(crate) fn is_number(digits: &str) -> bool {
    let begins = digits.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    matches!(digits, "inf" | "NaN")
        || begins && !digits.ends_with('_') && digits.replace('_', "").parse::<f64>().is_ok()
}

/// The content of a string, which begins at this byte, with its escapes replaced.
fn unescaped(written: &str, start: usize) -> Result<Box<str>, Wrong> {
    let mut out = String::with_capacity(written.len());
    let mut rest = written;
    while let Some(at) = rest.find('\\') {
        out.push_str(&rest[..at]);
        let after = &rest[at + 1..];
        let Some((c, length)) = escape(after) else {
            let shown: String = after.chars().take(1).collect();
            let place = start + written.len() - rest.len() + at;
            return wrong(place, format!("`\\{shown}` is no escape; a backslash is written `\\\\`"));
        };
        out.push(c);
        rest = &after[length..];
    }
    out.push_str(rest);
    Ok(out.into())
}

/// The character that an escape stands for, and the number of bytes after the backslash.
fn escape(after: &str) -> Option<(char, usize)> {
    let plain = |c| Some((c, 1));
    match after.as_bytes().first()? {
        b'n' => plain('\n'),
        b'r' => plain('\r'),
        b't' => plain('\t'),
        b'0' => plain('\0'),
        b'\\' => plain('\\'),
        b'"' => plain('"'),
        b'\'' => plain('\''),
        b'x' => {
            let code = u8::from_str_radix(after.get(1..3)?, 16).ok()?;
            Some((char::from(code), 3))
        }
        b'u' => {
            let digits = after.strip_prefix("u{")?.split_once('}')?.0;
            Some((char::from_u32(u32::from_str_radix(digits, 16).ok()?)?, digits.len() + "u{}".len()))
        }
        _ => None,
    }
}
