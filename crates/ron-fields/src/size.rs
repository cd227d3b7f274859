//! Checks the size of a text before anything is built from it.

use thiserror::Error;

use crate::cursor::{Cursor, is_of_name};
use crate::limits::{Limit, NESTING, STRING_BYTES, VALUES};

/// A text that exceeds a limit.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("must have at most {most} {what}")]
pub struct TooMuch {
    /// Line at which the limit is exceeded, from 1.
    pub line: usize,
    /// Column at which the limit is exceeded, from 1, in characters.
    pub column: usize,
    /// The limit.
    pub most: usize,
    /// The limited quantity, in words.
    pub what: &'static str,
}

/// Counts brackets, values and the bytes of strings, in one pass that builds nothing.
///
/// # Errors
/// The first place at which a text exceeds [`NESTING`], [`VALUES`] or [`STRING_BYTES`].
pub fn check_size(text: &str) -> Result<(), TooMuch> {
    let mut cursor = Cursor::new(text);
    let (mut depth, mut values) = (0_usize, 0_usize);
    loop {
        cursor.skip_blank();
        let start = cursor.at();
        match cursor.peek() {
            None => return Ok(()),
            Some(b'(' | b'[' | b'{') => {
                (depth, values) = (depth + 1, values + 1);
                cursor.advance();
            }
            Some(b')' | b']' | b'}') => {
                depth = depth.saturating_sub(1);
                cursor.advance();
            }
            Some(b',') => {
                values += 1;
                cursor.advance();
            }
            Some(b'"') => cursor.quoted(b'"'),
            Some(byte) if is_of_name(byte) && !byte.is_ascii_digit() => name_or_string(&mut cursor),
            Some(_) => cursor.advance(),
        }
        let length = cursor.at() - start;
        let found = [
            (depth, NESTING, "brackets within one another"),
            (values, VALUES, "values"),
            (length, STRING_BYTES, "bytes in a string or a name"),
        ];
        if let Some((_, limit, what)) = found.into_iter().find(|(count, limit, _)| *count > limit.count()) {
            return Err(too_much(text, start, limit, what));
        }
    }
}

/// Steps over a name, or over a string with a prefix: `r"..."`, `b"..."`.
fn name_or_string(cursor: &mut Cursor) {
    match (cursor.identifier(), cursor.peek()) {
        ("r" | "br", Some(b'"' | b'#')) => cursor.raw_string(),
        ("b", Some(b'"')) => cursor.quoted(b'"'),
        _ => {}
    }
}

fn too_much(text: &str, at: usize, limit: Limit, what: &'static str) -> TooMuch {
    let before = String::from_utf8_lossy(&text.as_bytes()[..at]);
    let line = 1 + before.matches('\n').count();
    let column = 1 + before.rsplit('\n').next().unwrap_or_default().chars().count();
    TooMuch { line, column, most: limit.count(), what }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(text: &str) -> Option<(usize, usize, String)> {
        check_size(text).err().map(|found| (found.line, found.column, found.to_string()))
    }

    #[test]
    fn each_limit_holds_at_the_limit_and_not_one_above() {
        let nested = |depth: usize| format!("\n{}{}", "[".repeat(depth), "]".repeat(depth));
        assert_eq!(said(&nested(NESTING.count())), None);
        let too_deep = "must have at most 64 brackets within one another".to_owned();
        assert_eq!(said(&nested(NESTING.count() + 1)), Some((2, 65, too_deep)));
        let values = |count: usize| format!("[{}]", "1,".repeat(count - 1));
        assert_eq!(said(&values(VALUES.count())), None);
        assert!(said(&values(VALUES.count() + 1)).unwrap().2.ends_with("at most 200000 values"));
        let string = |bytes: usize| format!("(\"{}\")", "x".repeat(bytes - 2));
        assert_eq!(said(&string(STRING_BYTES.count())), None);
        assert_eq!(
            said(&string(STRING_BYTES.count() + 1)).map(|(line, column, _)| (line, column)),
            Some((1, 2))
        );
        assert!(said(&"a".repeat(STRING_BYTES.count() + 1)).is_some());
    }

    #[test]
    fn what_stands_in_strings_and_comments_does_not_count() {
        let brackets = "[".repeat(1000);
        for text in [
            format!("(a: \"{brackets}\")"),
            format!("(a: r#\"{brackets}\"#)"),
            format!("(a: b\"{brackets}\")"),
            format!("// {brackets}\n(/* /* {brackets} */ {brackets} */)"),
        ] {
            assert_eq!(said(&text), None);
        }
        assert!(said(&"[".repeat(1_000_000)).is_some());
        assert!(said(&"Some(".repeat(500_000)).is_some());
    }
}
