//! From a text to its tree. The first place that is not well-formed, or that exceeds a limit, is told in the
//! terms of the text: which bracket is not closed, where a comma is missing.

mod words;

use crate::limits::{Limit, NESTING, STRING_BYTES, VALUES};
use crate::malformed::Malformed;
use crate::node::{Node, Place, Value};
pub(crate) use words::is_number;

/// Largest number of characters of the text that a message quotes.
const MOST_SHOWN: usize = 24;

/// A smallest part of a text, for its layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    Open,
    Close,
    Comma,
    Colon,
    /// A name, a number or a string.
    Word,
    /// `// ...`, without the line break.
    Line,
    /// `/* ... */`.
    Block,
}

/// A part and its bytes in the text.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Token {
    pub(crate) part: Part,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

impl Node {
    /// The tree of a text.
    ///
    /// # Errors
    /// The first place that is not well-formed, or that exceeds a [limit](mod@crate::limits).
    pub fn parse(text: &str) -> Result<Self, Malformed> {
        parse(text).map(|(root, _)| root)
    }
}

/// The tree of a text, and the parts of which the text consists.
pub(crate) fn parse(text: &str) -> Result<(Node, Vec<Token>), Malformed> {
    let mut reader = Reader::new(text);
    let root = reader.whole();
    root.map(|root| (root, reader.tokens)).map_err(|(at, message)| Malformed::new(text, at, message))
}

/// The byte at which the text is wrong, and the message.
type Wrong = (usize, String);

fn wrong<T>(at: usize, message: impl Into<String>) -> Result<T, Wrong> {
    Err((at, message.into()))
}

/// The entries between two brackets.
enum Entries {
    Named(Vec<(Node, Node)>),
    Plain(Vec<Node>),
}

struct Reader<'t> {
    text: &'t str,
    at: usize,
    /// Line of the byte `counted`.
    line: u32,
    counted: usize,
    /// Brackets that are open.
    depth: usize,
    /// Values so far.
    values: usize,
    /// Byte at which the last string begins that continues beyond its line.
    long_string: Option<usize>,
    tokens: Vec<Token>,
}

impl<'t> Reader<'t> {
    fn new(text: &'t str) -> Self {
        let tokens = Vec::new();
        Self { text, at: 0, line: 1, counted: 0, depth: 0, values: 0, long_string: None, tokens }
    }

    fn whole(&mut self) -> Result<Node, Wrong> {
        self.blank()?;
        if self.peek().is_none() {
            return wrong(0, "has no value: only blanks and comments");
        }
        let line = self.line();
        let root = self.value("the file", line)?;
        self.blank()?;
        if self.peek().is_none() {
            return Ok(root);
        }
        wrong(self.at, format!("nothing may follow the end of the value, found {}", self.here()))
    }

    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn rest(&self) -> &'t [u8] {
        &self.text.as_bytes()[self.at..]
    }

    fn since(&self, start: usize) -> &'t str {
        self.text.get(start..self.at).unwrap_or_default()
    }

    fn skip_while(&mut self, goes_on: impl Fn(u8) -> bool) {
        self.at += self.rest().iter().take_while(|byte| goes_on(**byte)).count();
    }

    /// Notes the part from `start` to here.
    fn token(&mut self, part: Part, start: usize) {
        self.tokens.push(Token { part, start, end: self.at });
    }

    /// Steps over one byte that is a part of its own.
    fn step(&mut self, part: Part) {
        self.at += 1;
        self.token(part, self.at - 1);
    }

    /// The line of this place; places only move on.
    fn line(&mut self) -> u32 {
        let passed = self.text.get(self.counted..self.at).unwrap_or_default();
        self.line += passed.matches('\n').count() as u32;
        self.counted = self.at;
        self.line
    }

    /// Steps over blanks and comments.
    fn blank(&mut self) -> Result<(), Wrong> {
        loop {
            self.skip_while(|byte| byte.is_ascii_whitespace());
            let start = self.at;
            if self.rest().starts_with(b"//") {
                self.skip_while(|byte| byte != b'\n');
                self.token(Part::Line, start);
            } else if self.rest().starts_with(b"/*") {
                self.block_comment()?;
                self.token(Part::Block, start);
            } else {
                return Ok(());
            }
        }
    }

    fn block_comment(&mut self) -> Result<(), Wrong> {
        let (start, mut depth) = (self.at, 0);
        while self.peek().is_some() {
            if self.rest().starts_with(b"/*") {
                (self.at, depth) = (self.at + 2, depth + 1);
            } else if self.rest().starts_with(b"*/") {
                (self.at, depth) = (self.at + 2, depth - 1);
                if depth == 0 {
                    return Ok(());
                }
            } else {
                self.at += 1;
            }
        }
        wrong(start, "the comment `/*` is not closed by `*/`")
    }

    /// The beginning of the next part, as a message quotes it.
    fn here(&self) -> String {
        self.shown(self.at)
    }

    fn shown(&self, at: usize) -> String {
        let rest = self.text.get(at..).unwrap_or_default();
        let is_end = |c: char| c.is_whitespace() || ",:()[]{}".contains(c);
        let first = rest.chars().next().map_or(0, char::len_utf8);
        let end = rest.get(first..).and_then(|rest| rest.find(is_end)).map_or(rest.len(), |end| end + first);
        let shown: String = rest.get(..end).unwrap_or(rest).chars().take(MOST_SHOWN).collect();
        if shown.is_empty() { "the end of the file".to_owned() } else { format!("`{shown}`") }
    }

    /// Refuses more than a limit allows.
    fn check(at: usize, count: usize, limit: Limit, what: &str) -> Result<(), Wrong> {
        if count <= limit.count() {
            return Ok(());
        }
        wrong(at, format!("must have at most {} {what}", limit.count()))
    }

    /// Reads a value; `what` describes its owner in messages.
    fn value(&mut self, what: &str, line: u32) -> Result<Node, Wrong> {
        self.blank()?;
        let start = self.at;
        self.values += 1;
        Self::check(start, self.values, VALUES, "values")?;
        let value = match self.peek() {
            Some(b'(') => self.round(Box::default())?,
            Some(b'[') => match self.entries(b']')? {
                Entries::Plain(list) => Value::List(list),
                Entries::Named(_) => Value::List(Vec::new()), // entries of a list have no names
            },
            Some(b'{') => match self.entries(b'}')? {
                Entries::Named(map) => Value::Map(map),
                Entries::Plain(_) => Value::Map(Vec::new()), // an empty one
            },
            Some(b'"') => Value::Text(self.string()?),
            Some(b'\'') => return wrong(start, "texts are written in double quotes: \"...\""),
            Some(b'#') => {
                let message = "extensions change what a file means and are not allowed; remove `#![...]`";
                return wrong(start, message);
            }
            Some(byte) if starts_name(byte) => self.named()?,
            Some(byte) if byte.is_ascii_digit() || b"+-.".contains(&byte) => self.number()?,
            _ => {
                let message = format!("a value is missing: {what} must have one, found {}", self.here());
                return wrong(start, message);
            }
        };
        let place = Place { line, start: start as u32, end: self.at as u32 };
        Ok(Node { place, value })
    }

    /// Reads `(...)` after a name, which may be empty.
    fn round(&mut self, name: Box<str>) -> Result<Value, Wrong> {
        Ok(match self.entries(b')')? {
            Entries::Plain(entries) => Value::Tuple(name, entries),
            Entries::Named(fields) => Value::Struct(name, fields),
        })
    }

    /// Steps over letters, digits and `_`, and returns them.
    fn identifier(&mut self) -> &'t str {
        let start = self.at;
        self.skip_while(is_of_name);
        self.since(start)
    }

    /// Reads a name, alone or before brackets, or a string with a prefix.
    fn named(&mut self) -> Result<Value, Wrong> {
        let start = self.at;
        let name = self.identifier();
        let is_raw = name == "r" && self.rest().iter().find(|byte| **byte != b'#') == Some(&b'"');
        if is_raw {
            return self.raw_string(start);
        }
        if name.contains(['“', '”', '„', '‘', '’', '«', '»']) {
            return wrong(start, "texts are written in straight quotes: \"...\"");
        }
        if !name.is_ascii() {
            let found = self.shown(start);
            return wrong(start, format!("{found} is no value: numbers, \"texts\", names and brackets are"));
        }
        Self::check(start, name.len(), STRING_BYTES, "bytes in a string or a name")?;
        self.token(Part::Word, start);
        let (end, tokens) = (self.at, self.tokens.len());
        self.blank()?;
        if self.peek() == Some(b'(') {
            return self.round(name.into());
        }
        self.go_back(end, tokens);
        Ok(Value::Word(name.into()))
    }

    /// Goes back to an earlier place, with the parts before it.
    fn go_back(&mut self, at: usize, tokens: usize) {
        self.at = at;
        self.tokens.truncate(tokens);
    }

    /// Reads the content of brackets, including both brackets.
    fn entries(&mut self, close: u8) -> Result<Entries, Wrong> {
        let open = self.at;
        self.depth += 1;
        Self::check(open, self.depth, NESTING, "brackets within one another")?;
        self.step(Part::Open);
        let (mut fields, mut plain) = (Vec::new(), Vec::new());
        loop {
            self.blank()?;
            match self.peek() {
                Some(byte) if byte == close => {
                    self.step(Part::Close);
                    self.depth -= 1;
                    self.check_doubled(&fields)?;
                    let is_plain = fields.is_empty();
                    return Ok(if is_plain { Entries::Plain(plain) } else { Entries::Named(fields) });
                }
                Some(b')' | b']' | b'}') | None => return self.not_closed(open, close),
                Some(b',') => return wrong(self.at, "an entry is missing before `,`"),
                Some(_) => {
                    let line = self.line();
                    match self.name(close, !fields.is_empty(), !plain.is_empty())? {
                        Some(name) => {
                            let owner = format!("`{}`", self.text_of(&name));
                            let value = self.value(&owner, line)?;
                            fields.push((name, value));
                        }
                        None if close == b']' => plain.push(self.value("the list's entry", line)?),
                        None => plain.push(self.value("the entry", line)?),
                    }
                }
            }
            let end = self.at;
            self.blank()?;
            match self.peek() {
                Some(b',') => self.step(Part::Comma),
                Some(b')' | b']' | b'}') | None => {}
                Some(_) => return self.no_comma(end),
            }
        }
    }

    fn text_of(&self, node: &Node) -> &'t str {
        self.text.get(node.bytes()).unwrap_or_default()
    }

    /// Refuses two fields of one name.
    fn check_doubled(&self, fields: &[(Node, Node)]) -> Result<(), Wrong> {
        let mut names: Vec<&Node> = fields.iter().map(|(name, _)| name).collect();
        names.sort_by_key(|name| (self.text_of(name), name.place.start));
        let twice = names.array_windows().filter(|[a, b]| self.text_of(a) == self.text_of(b));
        match twice.min_by_key(|[_, second]| second.place.start) {
            None => Ok(()),
            Some([first, second]) => {
                let name = self.text_of(second);
                let message = format!("`{name}` is given twice; line {} has it first", first.place.line);
                wrong(second.place.start as usize, message)
            }
        }
    }

    fn not_closed<T>(&self, open: usize, close: u8) -> Result<T, Wrong> {
        let line = 1 + self.text[..open].matches('\n').count();
        let (bracket, close, found) = (&self.text[open..=open], close as char, self.here());
        wrong(
            self.at,
            format!("`{bracket}` of line {line} is not closed: `{close}` is missing, found {found}"),
        )
    }

    fn no_comma<T>(&self, end: usize) -> Result<T, Wrong> {
        let found = self.here();
        if let Some(at) = self.long_string {
            return wrong(at, "the string is not closed on its line by `\"`");
        }
        let word = found.trim_matches('`');
        let after = self.text.get(self.at + word.len()..).unwrap_or_default().trim_start();
        let is_unit = word.len() <= 4 && word.chars().all(char::is_alphabetic) && !after.starts_with(':');
        if is_unit && self.text[..end].ends_with(|c: char| c.is_ascii_digit()) {
            return wrong(self.at, format!("a number is written without its unit, found {found}"));
        }
        let message = match self.peek() {
            Some(b'=') => "a field is written with a colon, as in `name: value`, found `=`",
            Some(b';') => "entries are separated by commas, found `;`",
            Some(b':') => {
                "found `:` after a value: a comma is missing before the field, or the name of the field"
            }
            _ => return wrong(end, format!("a comma is missing before {found}")),
        };
        wrong(self.at, message)
    }

    /// Reads the name of a field and its colon; `None` for an entry without a name. Within one pair of
    /// brackets, all are of one kind: the earlier ones have names, or are plain.
    fn name(&mut self, close: u8, have_names: bool, are_plain: bool) -> Result<Option<Node>, Wrong> {
        if close == b']' {
            return Ok(None);
        }
        let (start, tokens) = (self.at, self.tokens.len());
        let value = if self.peek() == Some(b'"') {
            Value::Text(self.string()?)
        } else {
            let name = self.identifier();
            Self::check(start, name.len(), STRING_BYTES, "bytes in a string or a name")?;
            self.token(Part::Word, start);
            Value::Word(name.into())
        };
        let (end, written) = (self.at, self.since(start));
        let is_name = written.bytes().next().is_some_and(|byte| !byte.is_ascii_digit());
        self.blank()?;
        if is_name && self.peek() == Some(b':') {
            if are_plain {
                let found = self.shown(start);
                return wrong(start, format!("{found} has a name, which the entries before it have not"));
            }
            if close == b')' && matches!(value, Value::Text(_)) {
                return wrong(start, format!("the name of a field has no quotes, found {written}"));
            }
            self.step(Part::Colon);
            let place = Place { line: self.line, start: start as u32, end: end as u32 };
            return Ok(Some(Node { place, value }));
        }
        if have_names || close == b'}' {
            return self.no_name(start, end, is_name);
        }
        self.go_back(start, tokens);
        Ok(None)
    }

    fn no_name<T>(&self, start: usize, end: usize, is_name: bool) -> Result<T, Wrong> {
        let (name, found) = (&self.text[start..end], self.shown(start));
        if self.peek() == Some(b'=') {
            let message = format!("a field is written with a colon, as in `{name}: value`, found `=`");
            return wrong(if is_name { end } else { start }, message);
        }
        if is_name {
            return wrong(end, format!("`:` is missing after {found}"));
        }
        let is_decimal =
            self.text[..start].ends_with(',') && self.text[start..].starts_with(|c: char| c.is_ascii_digit());
        let point = if is_decimal { "; decimals are written with a point" } else { "" };
        wrong(start, format!("the name of a field is missing before {found}{point}"))
    }
}

/// Whether a byte may occur in a name. Each byte of a letter beyond ASCII may.
fn is_of_name(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_' || !byte.is_ascii()
}

fn starts_name(byte: u8) -> bool {
    is_of_name(byte) && !byte.is_ascii_digit()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> Wrong {
        Reader::new(text).whole().expect_err(text)
    }

    #[test]
    fn what_is_wrong_is_told_in_words_of_the_text() {
        for (text, at, says) in [
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
            ("(a: \"x\\q\")", 6, "`\\q` is no escape; a backslash is written `\\\\`"),
            ("(a: 'x')", 4, "texts are written in double quotes: \"...\""),
            ("(a: “x”)", 4, "texts are written in straight quotes: \"...\""),
            ("(\"a\": 1)", 1, "the name of a field has no quotes, found \"a\""),
            ("(a: 10m)", 4, "a number is written without its unit, found `10m`"),
            ("(a: 1.2.3)", 4, "`1.2.3` is no number"),
            ("(a: 1)) ", 6, "nothing may follow the end of the value, found `)`"),
            ("(a: 1) b", 7, "nothing may follow the end of the value, found `b`"),
            ("(a: 1 /* no end", 6, "the comment `/*` is not closed by `*/`"),
            ("// nothing", 0, "has no value: only blanks and comments"),
            ("{\"a\" 1}", 4, "`:` is missing after `\"a\"`"),
            ("(a: 1,\n b: 2,\n a: 3)", 15, "`a` is given twice; line 1 has it first"),
            ("{\"a\": 1, \"b\": (c: 1,\nc: 2)}", 21, "`c` is given twice; line 1 has it first"),
        ] {
            assert_eq!(message(text), (at, says.to_owned()), "{text}");
        }
    }

    #[test]
    fn each_limit_holds_at_the_limit_and_not_one_above() {
        let nested = |depth: usize| format!("{}{}", "[".repeat(depth), "]".repeat(depth));
        let values = |count: usize| format!("[{}]", "1,".repeat(count - 1));
        let string = |bytes: usize| format!("(\"{}\")", "x".repeat(bytes - 2));
        let (depth, many, long) = (NESTING.count(), VALUES.count(), STRING_BYTES.count());
        for text in [nested(depth), values(many), string(long)] {
            assert!(Reader::new(&text).whole().is_ok());
        }
        for (text, says) in [
            (nested(depth + 1), "must have at most 64 brackets within one another"),
            (values(many + 1), "must have at most 200000 values"),
            (string(long + 1), "must have at most 65536 bytes in a string or a name"),
            ("a".repeat(long + 1), "must have at most 65536 bytes in a string or a name"),
            ("Some(".repeat(500_000), "must have at most 64 brackets within one another"),
        ] {
            assert_eq!(message(&text).1, says);
        }
        let brackets = "[".repeat(1000);
        for text in [format!("(a: \"{brackets}\")"), format!("// {brackets}\n(/* /* {brackets} */ */)")] {
            assert!(Reader::new(&text).whole().is_ok());
        }
    }

    #[test]
    fn what_is_well_formed_is_read_and_nothing_leads_astray() {
        for text in [
            "()",
            "(a: 1, b: [1, 2.5, -3e4, +1, .5, 1_000, 0x1F, inf, -inf, NaN], c: (1, 2), d: \"x\\\\\", e: \
             r#\"a\"b\"#,)",
            "Named(a: Some(1), b: Unit, c: Tuple(1, 2), d: {\"a\": 1, \"b\": [],}, e: (), f: true) // end",
            "/* a /* nested */ comment */ [(), [],]",
            "// first\n(a: 1/* in */, // after\n b: 2// last\n)\n/* last */",
            "(größe: 1)",
            "(a: 1) // the last line /* has this",
        ] {
            assert!(Reader::new(text).whole().is_ok(), "{text}: {:?}", message(text));
        }
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
            "(a: \"\\日",
            "(a: '日')",
            "r",
            "r#",
            "(a: /)",
        ] {
            assert!(Reader::new(text).whole().is_err() || text == "r", "{text}");
        }
    }

    #[test]
    fn escapes_are_those_of_ron() {
        let text = r#""\n\t\\\"\x41\u{1F916}""#;
        let root = Reader::new(text).whole().unwrap();
        assert_eq!(root.value, Value::Text("\n\t\\\"A🤖".into()));
    }
}
