//! Finds the line of a field in a RON text, so that a broken rule is reported where the user can mend it.
//!
//! RON's deserialiser gives positions for its own errors only. This walks a text that is already known to be well-formed
//! and notes the line at which each field and list entry starts.

/// Lines of the fields of one text.
pub(super) struct FieldLines {
    lines: Vec<(String, usize)>,
}

impl FieldLines {
    /// Walks the whole text.
    pub(super) fn of(text: &str) -> Self {
        let mut walker = Walker { text: text.as_bytes(), at: 0, breaks: 0, counted: 0, lines: Vec::new() };
        walker.value("");
        Self { lines: walker.lines }
    }

    /// Line (from 1) of a field such as `tasks.hard.grid[0]`, or of the nearest field around it that is written down.
    pub(super) fn find(&self, field: &str) -> Option<usize> {
        let mut field = field;
        loop {
            if let Some((_, line)) = self.lines.iter().find(|(path, _)| path == field) {
                return Some(*line);
            }
            field = &field[..field.rfind(['.', '['])?];
        }
    }
}

struct Walker<'a> {
    text: &'a [u8],
    at: usize,
    /// Line breaks before `counted`.
    breaks: usize,
    counted: usize,
    lines: Vec<(String, usize)>,
}

impl Walker<'_> {
    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    /// The line of the present position.
    fn line(&mut self) -> usize {
        let new = String::from_utf8_lossy(&self.text[self.counted..self.at]);
        self.breaks += new.matches('\n').count();
        self.counted = self.at;
        1 + self.breaks
    }

    fn starts_with(&self, what: &[u8]) -> bool {
        self.text[self.at.min(self.text.len())..].starts_with(what)
    }

    /// Skips white space, `// ...` and nested `/* ... */`.
    fn skip_blank(&mut self) {
        while let Some(byte) = self.peek() {
            if self.starts_with(b"//") {
                while self.peek().is_some_and(|b| b != b'\n') {
                    self.at += 1;
                }
            } else if self.starts_with(b"/*") {
                self.skip_block_comment();
            } else if byte.is_ascii_whitespace() {
                self.at += 1;
            } else {
                return;
            }
        }
    }

    fn skip_block_comment(&mut self) {
        let mut depth = 0;
        while self.at < self.text.len() {
            if self.starts_with(b"/*") {
                depth += 1;
                self.at += 2;
            } else if self.starts_with(b"*/") {
                depth -= 1;
                self.at += 2;
                if depth == 0 {
                    return;
                }
            } else {
                self.at += 1;
            }
        }
    }

    fn identifier(&mut self) -> String {
        let start = self.at;
        while self.peek().is_some_and(|b| b.is_ascii_alphanumeric() || b == b'_') {
            self.at += 1;
        }
        String::from_utf8_lossy(&self.text[start..self.at]).into_owned()
    }

    fn value(&mut self, path: &str) {
        self.skip_blank();
        match self.peek() {
            Some(b'(' | b'[' | b'{') => self.entries(path),
            Some(b'"') => self.string(),
            Some(b'\'') => self.at += 3,
            Some(b) if b.is_ascii_alphabetic() || b == b'_' => {
                let name = self.identifier();
                if name == "r" && matches!(self.peek(), Some(b'"' | b'#')) {
                    return self.raw_string();
                }
                self.skip_blank();
                if self.peek() == Some(b'(') {
                    // `Some(..)` is the value itself; any other name is a struct or a variant with fields.
                    if name == "Some" {
                        self.at += 1;
                        self.value(path);
                        self.skip_blank();
                        self.at += 1;
                    } else {
                        self.entries(path);
                    }
                }
            }
            _ => {
                while self.peek().is_some_and(|b| !b",)]}".contains(&b) && !b.is_ascii_whitespace()) {
                    self.at += 1;
                }
            }
        }
    }

    /// Fields or elements between brackets.
    fn entries(&mut self, path: &str) {
        self.at += 1;
        let mut index = 0;
        loop {
            self.skip_blank();
            match self.peek() {
                None => return,
                Some(b')' | b']' | b'}') => {
                    self.at += 1;
                    return;
                }
                Some(b',') => self.at += 1,
                Some(_) => {
                    let line = self.line();
                    let entry = match self.field_name() {
                        Some(name) if path.is_empty() => name,
                        Some(name) => format!("{path}.{name}"),
                        None => format!("{path}[{index}]"),
                    };
                    self.lines.push((entry.clone(), line));
                    let before = self.at;
                    self.value(&entry);
                    self.at += usize::from(self.at == before); // never stands still, whatever the text
                    index += 1;
                }
            }
        }
    }

    /// The name before a `:`, which is skipped; or nothing, and nothing is skipped.
    fn field_name(&mut self) -> Option<String> {
        let start = self.at;
        let name = self.identifier();
        self.skip_blank();
        if !name.is_empty() && self.peek() == Some(b':') {
            self.at += 1;
            return Some(name);
        }
        self.at = start;
        None
    }

    fn string(&mut self) {
        self.at += 1;
        while let Some(byte) = self.peek() {
            self.at += if byte == b'\\' { 2 } else { 1 };
            if byte == b'"' {
                return;
            }
        }
    }

    fn raw_string(&mut self) {
        let mut end = vec![b'"'];
        while self.peek() == Some(b'#') {
            end.push(b'#');
            self.at += 1;
        }
        self.at += 1;
        while self.at < self.text.len() && !self.starts_with(&end) {
            self.at += 1;
        }
        self.at += end.len();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r##"// a comment with name: 1
(
    name: "a (tricky, \" one)", /* other: [ /* nested */ */
    raw: r#"x: (" "#,
    list: [
        (at: (1.0, 2.0), shape: Disc(0.5)),
        Named(at: (1.0,
            3.0), extra: Some((mass: 2.0))),
    ],
    last: -1e3,
)
"##;

    #[test]
    fn fields_are_found_where_they_stand() {
        let lines = FieldLines::of(TEXT);
        for (field, line) in [
            ("name", 3),
            ("raw", 4),
            ("list[0].at[1]", 6),
            ("list[0].shape", 6),
            ("list[1].at[1]", 8),
            ("list[1].extra.mass", 8),
            ("last", 10),
        ] {
            assert_eq!(lines.find(field), Some(line), "{field}");
        }
    }

    #[test]
    fn a_field_that_is_not_written_is_found_at_what_surrounds_it() {
        let lines = FieldLines::of(TEXT);
        assert_eq!(lines.find("list[1].rotation"), Some(7));
        assert_eq!(lines.find("absent.deep"), None);
    }

    #[test]
    fn broken_text_ends_the_walk() {
        for text in ["(", "(a: \"", "(a: r##\"", "/* /*", "(a: [", ")))", "(,,:,)"] {
            FieldLines::of(text);
        }
    }
}
