//! Finds the fields of a RON text: the line of one, so that a broken rule is reported where the user can mend it, and the text of its
//! value, so that it can be set.
//!
//! RON's deserialiser gives positions for its own errors only. This walks a text that is already known to be well-formed
//! and notes where each field and list entry stands.

use std::ops::Range;

/// Brackets within brackets that are followed.
const MAX_DEPTH: usize = 128;

/// Where the fields of one text stand.
pub struct Fields {
    fields: Vec<Field>,
}

/// A field or an entry of a list.
struct Field {
    /// Path such as `tasks.hard.grid[0]`.
    path: String,
    /// Line, from 1.
    line: usize,
    /// Bytes of its value.
    value: Range<usize>,
}

impl Fields {
    /// Walks the whole text.
    #[must_use]
    pub fn of(text: &str) -> Self {
        let mut walker =
            Walker { text: text.as_bytes(), at: 0, breaks: 0, counted: 0, fields: Vec::new(), depth: 0 };
        walker.value("");
        Self { fields: walker.fields }
    }

    /// The bytes of a field's value, if it is written down.
    #[must_use]
    pub fn value(&self, path: &str) -> Option<Range<usize>> {
        self.fields.iter().find(|field| field.path == path).map(|field| field.value.clone())
    }

    /// Paths and bytes of the values of all fields that have no fields of their own.
    pub fn leaves(&self) -> impl Iterator<Item = (&str, Range<usize>)> {
        // A field is noted before what is in it.
        let following = self.fields.iter().skip(1).map(Some).chain([None]);
        let is_leaf = |(field, next): &(&Field, Option<&Field>)| {
            next.is_none_or(|next| next.value.start >= field.value.end)
        };
        let pairs = self.fields.iter().zip(following);
        pairs.filter(is_leaf).map(|(field, _)| (field.path.as_str(), field.value.clone()))
    }

    /// Number of entries of a list that is written down.
    #[must_use]
    pub fn entries(&self, path: &str) -> Option<usize> {
        let is_entry = |field: &&Field| {
            let rest = field.path.strip_prefix(path).and_then(|rest| rest.strip_prefix('['));
            rest.is_some_and(|rest| rest.find(']') == Some(rest.len() - 1))
        };
        self.value(path)?;
        Some(self.fields.iter().filter(is_entry).count())
    }

    /// Names of the fields directly in a field; of the whole text for an empty path.
    #[must_use]
    pub fn inside(&self, path: &str) -> Vec<&str> {
        let directly = |field: &'_ Field| {
            let rest = field.path.strip_prefix(path)?;
            let rest = if path.is_empty() { rest } else { rest.strip_prefix('.')? };
            (!rest.contains(['.', '['])).then_some(field.path.len() - rest.len())
        };
        self.fields.iter().filter_map(|field| directly(field).map(|start| &field.path[start..])).collect()
    }

    /// Line (from 1) of a field such as `tasks.hard.grid[0]`, or of the nearest field around it that is written down.
    #[must_use]
    pub fn line(&self, path: &str) -> Option<usize> {
        let mut path = path;
        loop {
            if let Some(field) = self.fields.iter().find(|field| field.path == path) {
                return Some(field.line);
            }
            path = &path[..path.rfind(['.', '['])?];
        }
    }
}

struct Walker<'a> {
    text: &'a [u8],
    at: usize,
    /// Line breaks before `counted`.
    breaks: usize,
    counted: usize,
    fields: Vec<Field>,
    /// Open brackets.
    depth: usize,
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
            Some(b'"') => self.quoted(b'"'),
            Some(b'\'') => self.quoted(b'\''),
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
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            self.at = self.text.len(); // RON itself refuses such a text
        }
        let mut index = 0;
        loop {
            self.skip_blank();
            match self.peek() {
                None => return,
                Some(b')' | b']' | b'}') => {
                    self.at += 1;
                    self.depth -= 1;
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
                    self.skip_blank();
                    let (before, number) = (self.at, self.fields.len());
                    self.fields.push(Field { path: entry.clone(), line, value: before..before });
                    self.value(&entry);
                    self.at += usize::from(self.at == before); // never stands still, whatever the text
                    self.fields[number].value.end = self.at.min(self.text.len());
                    index += 1;
                }
            }
        }
    }

    /// The name before a `:`, which is skipped; or nothing, and nothing is skipped.
    fn field_name(&mut self) -> Option<String> {
        let start = self.at;
        if self.peek() == Some(b'"') {
            self.quoted(b'"'); // the key of a map
        } else {
            self.identifier();
        }
        let name = String::from_utf8_lossy(&self.text[start..self.at.min(self.text.len())]).into_owned();
        self.skip_blank();
        if !name.is_empty() && self.peek() == Some(b':') {
            self.at += 1;
            return Some(name);
        }
        self.at = start;
        None
    }

    /// A string or a character.
    fn quoted(&mut self, quote: u8) {
        self.at += 1;
        while let Some(byte) = self.peek() {
            self.at += if byte == b'\\' { 2 } else { 1 };
            if byte == quote {
                break;
            }
        }
        self.at = self.at.min(self.text.len());
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
    map: {"a.b": [1, 2]},
)
"##;

    #[test]
    fn fields_are_found_where_they_stand() {
        let fields = Fields::of(TEXT);
        for (field, line) in [
            ("name", 3),
            ("raw", 4),
            ("list[0].at[1]", 6),
            ("list[0].shape", 6),
            ("list[1].at[1]", 8),
            ("list[1].extra.mass", 8),
            ("last", 10),
            ("map.\"a.b\"[1]", 11),
        ] {
            assert_eq!(fields.line(field), Some(line), "{field}");
        }
    }

    #[test]
    fn a_field_that_is_not_written_is_found_at_what_surrounds_it() {
        let fields = Fields::of(TEXT);
        assert_eq!(fields.line("list[1].rotation"), Some(7));
        assert_eq!(fields.line("absent.deep"), None);
        assert_eq!(fields.value("absent.deep"), None);
    }

    #[test]
    fn the_text_of_a_value_is_found() {
        let fields = Fields::of(TEXT);
        for (path, value) in [
            ("name", r#""a (tricky, \" one)""#),
            ("raw", r##"r#"x: (" "#"##),
            ("list[0].at", "(1.0, 2.0)"),
            ("list[0].at[1]", "2.0"),
            ("list[0].shape", "Disc(0.5)"),
            ("list[1].extra.mass", "2.0"),
            ("last", "-1e3"),
        ] {
            assert_eq!(&TEXT[fields.value(path).unwrap()], value, "{path}");
        }
        let leaves: Vec<&str> = fields.leaves().map(|(path, _)| path).collect();
        assert_eq!(leaves[..4], ["name", "raw", "list[0].at[0]", "list[0].at[1]"]);
        assert_eq!(fields.inside(""), ["name", "raw", "list", "last", "map"]);
        assert_eq!(fields.inside("list[1]"), ["at", "extra"]);
    }

    #[test]
    fn broken_text_ends_the_walk() {
        for text in
            ["(", "(a: \"", "(a: r##\"", "/* /*", "(a: [", ")))", "(,,:,)", "(a: '", "(a: '\\", "(a: '日')"]
        {
            let fields = Fields::of(text);
            fields.leaves().for_each(|(_, value)| assert!(text.get(value).is_some(), "{text}"));
        }
        let _ = Fields::of(&"([{".repeat(100_000));
    }
}
