//! The place of a text that is not well-formed.

/// Most characters of a line that are shown before a caret.
const AROUND: usize = 48;

/// The first place of a text that is not well-formed or exceeds a limit.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}, column {column}: {message}")]
pub struct Malformed {
    /// Line, from 1.
    pub line: usize,
    /// Column, in characters from 1.
    pub column: usize,
    /// What is wrong.
    pub message: String,
    /// The line, with a caret below the column.
    pub excerpt: String,
}

impl Malformed {
    /// The error at this byte of a text.
    pub fn new(text: &str, at: usize, message: String) -> Self {
        let before = text.get(..at).unwrap_or(text);
        let line = 1 + before.matches('\n').count();
        let start = before.rfind('\n').map_or(0, |end| end + 1);
        let column = 1 + before[start..].chars().count();
        let from = (column - 1).saturating_sub(AROUND);
        let whole = text[start..].lines().next().unwrap_or_default();
        let shown = whole.chars().skip(from).take(2 * AROUND);
        let shown: String = shown.map(|c| if c == '\t' { ' ' } else { c }).collect();
        let excerpt = format!("    {shown}\n    {}^", " ".repeat(column - 1 - from));
        Self { line, column, message, excerpt }
    }
}
