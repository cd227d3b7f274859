//! Walks over a text and records the place of each field and list entry.

use crate::cursor::{Cursor, is_of_name};
use crate::fields::{Fields, Node, ROOT};
use crate::path::is_segment;

/// Largest number of nested brackets that are followed.
const MAX_DEPTH: usize = 128; // more than any text that is read has

impl Fields {
    /// Walks the whole text.
    #[must_use]
    pub fn of(text: &str) -> Self {
        Walker::fields(text, usize::MAX)
    }

    /// Walks the whole text and keeps only the outermost fields.
    #[must_use]
    pub fn outer(text: &str) -> Self {
        Walker::fields(text, 1)
    }
}

struct Walker<'a> {
    cursor: Cursor<'a>,
    nodes: Vec<Node>,
    /// Number of open brackets.
    depth: usize,
    /// Number of open brackets up to which fields and entries are kept.
    kept: usize,
}

impl<'a> Walker<'a> {
    /// Walks a whole text.
    fn fields(text: &'a str, kept: usize) -> Fields {
        let nodes = vec![Node::new(Box::from(""), 1, 0)];
        let mut walker = Self { cursor: Cursor::new(text), nodes, depth: 0, kept };
        walker.cursor.skip_attributes();
        walker.value(ROOT);
        let nodes = walker.nodes;
        let mut index: Vec<u32> = (1..nodes.len() as u32).collect();
        index.sort_by(|a, b| nodes[*a as usize].path.cmp(&nodes[*b as usize].path));
        Fields { nodes, index }
    }

    /// Reads a value; its fields and entries become those of the node.
    fn value(&mut self, node: usize) {
        self.cursor.skip_blank();
        match self.cursor.peek() {
            Some(b'(' | b'[' | b'{') => self.entries(node),
            Some(quote @ (b'"' | b'\'')) => self.cursor.quoted(quote),
            Some(byte) if is_of_name(byte) && !byte.is_ascii_digit() => self.named_value(node),
            _ => self.cursor.word(),
        }
    }

    /// Reads a value that begins with a name: `true`, `Some(1)`, `Disc(0.5)`, `b"bytes"`, `r"raw"`.
    fn named_value(&mut self, node: usize) {
        let name = self.cursor.identifier();
        match (name, self.cursor.peek()) {
            ("r" | "br", Some(b'"' | b'#')) => return self.cursor.raw_string(),
            ("b", Some(quote @ (b'"' | b'\''))) => return self.cursor.quoted(quote),
            _ => {}
        }
        let end = self.cursor.at();
        self.cursor.skip_blank();
        match self.cursor.peek() {
            // `Some(..)` is the value itself; any other name is a struct or a variant with fields.
            Some(b'(') if name == "Some" => self.wrapped_value(node),
            Some(b'(') => self.entries(node),
            _ => self.cursor.go_back(end),
        }
    }

    fn wrapped_value(&mut self, node: usize) {
        self.depth += 1;
        self.cursor.advance();
        if self.depth > MAX_DEPTH {
            self.cursor.end(); // RON itself refuses such a text
        }
        self.value(node);
        self.cursor.skip_blank();
        self.cursor.advance();
        self.depth -= 1;
    }

    /// Reads the fields or elements between brackets.
    fn entries(&mut self, parent: usize) {
        self.nodes[parent].is_list = self.cursor.peek() == Some(b'[');
        self.cursor.advance();
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            self.cursor.end(); // RON itself refuses such a text
        }
        let mut number = 0;
        loop {
            self.cursor.skip_blank();
            match self.cursor.peek() {
                None => return,
                Some(b')' | b']' | b'}') => {
                    self.cursor.advance();
                    self.depth -= 1;
                    return;
                }
                Some(b',') => self.cursor.advance(),
                Some(_) => {
                    self.entry(parent, number);
                    number += 1;
                }
            }
        }
    }

    /// Reads one field or element.
    fn entry(&mut self, parent: usize, number: usize) {
        let line = self.cursor.line();
        let name = self.field_name();
        if self.depth > self.kept {
            return self.left_out(parent);
        }
        let around = &self.nodes[parent].path;
        let path: Box<str> = match name {
            Some(name) if around.is_empty() => name.into(),
            Some(name) => format!("{around}.{name}").into(),
            None => format!("{around}[{number}]").into(),
        };
        self.cursor.skip_blank();
        let (start, node) = (self.cursor.at(), self.nodes.len());
        self.nodes[parent].children.push(node as u32);
        self.nodes.push(Node::new(path, line, start));
        self.value(node);
        if self.cursor.at() == start {
            self.cursor.advance(); // never stands still, whatever the text
        }
        self.nodes[node].value.end = self.cursor.at();
        match name {
            Some("name") => self.note_name(parent, start),
            Some(_) => {}
            None => self.note_entry(parent, node),
        }
    }

    /// Steps over the value of an entry that is not kept.
    fn left_out(&mut self, parent: usize) {
        self.cursor.skip_blank();
        let start = self.cursor.at();
        self.value(parent);
        if self.cursor.at() == start {
            self.cursor.advance(); // never stands still, whatever the text
        }
    }

    /// Stores the value of a node's field `name`, in case the node is an entry of a list.
    fn note_name(&mut self, node: usize, start: usize) {
        let value = self.cursor.since(start);
        let value = value.strip_prefix("Some(").and_then(|value| value.strip_suffix(')')).unwrap_or(value);
        let name = value.strip_prefix('"').and_then(|value| value.strip_suffix('"'));
        let node = &mut self.nodes[node];
        node.name = node.name.take().or(name.filter(|name| is_segment(name)).map(Into::into));
    }

    /// Makes an entry available by its name, unless an earlier entry has the same name.
    fn note_entry(&mut self, list: usize, entry: usize) {
        if let Some(name) = self.nodes[entry].name.take() {
            self.nodes[list].named.get_or_insert_default().entry(name).or_insert(entry);
        }
    }

    /// Steps over a name and its `:`, and returns the name. Without them, returns `None` and skips nothing.
    fn field_name(&mut self) -> Option<&'a str> {
        let start = self.cursor.at();
        let name = if self.cursor.peek() == Some(b'"') {
            self.cursor.quoted(b'"'); // the key of a map
            self.cursor.since(start)
        } else {
            self.cursor.identifier()
        };
        self.cursor.skip_blank();
        if !name.is_empty() && self.cursor.peek() == Some(b':') {
            self.cursor.advance();
            return Some(name);
        }
        self.cursor.go_back(start);
        None
    }
}

#[cfg(test)]
mod tests {
    use crate::Fields;

    #[test]
    fn broken_text_ends_the_walk() {
        for text in [
            "(",
            "(a: \"",
            "(a: r##\"",
            "/* /*",
            "(a: [",
            ")))",
            "(,,:,)",
            "(a: '",
            "(a: '\\",
            "(a: '日')",
            "(a: \"\\日",
            "(a: /)",
            "(r#: 1)",
            "(r#a",
            "#!",
            "#![",
            "b'",
            "(日: 日",
            "(name: \")",
            "[(name: \"",
            "Some(",
        ] {
            let fields = Fields::of(text);
            fields.leaves().for_each(|(_, value)| assert!(text.get(value).is_some(), "{text}"));
        }
        let _ = Fields::of(&"([{".repeat(100_000));
        let _ = Fields::of(&"Some(".repeat(100_000));
    }

    #[test]
    fn a_value_ends_before_what_follows_it() {
        let text = "(a: Fast /* as can be */, b: 1.5/* m */, c: 2// last\n, d: Slow // at the end\n)";
        let fields = Fields::of(text);
        for (path, value) in [("a", "Fast"), ("b", "1.5"), ("c", "2"), ("d", "Slow")] {
            assert_eq!(&text[fields.value(path).unwrap()], value);
        }
    }

    #[test]
    fn every_form_of_name_and_string_is_followed() {
        let text = "#![enable(implicit_some)] // all of it\nRoot(größe: b\"(\", r#type: br#\")\"#, k: b'(', \
            r#a-b: r\"]\", end: 1)";
        let fields = Fields::of(text);
        assert_eq!(fields.inside(""), ["größe", "type", "k", "a-b", "end"]);
        for (path, value) in [("größe", "b\"(\""), ("type", "br#\")\"#"), ("a-b", "r\"]\""), ("end", "1")] {
            assert_eq!(&text[fields.value(path).unwrap()], value);
        }
        assert_eq!(fields.line("end"), Some(2));
    }
}
