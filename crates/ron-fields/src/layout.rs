//! The layout of a text: indents, blanks, commas at ends of lines. Line breaks and comments stay unchanged.

use crate::cursor::Cursor;

/// Number of blanks of one indent.
const INDENT: usize = 4;

/// A smallest part of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part<'t> {
    Open(&'t str),
    Close(&'t str),
    Comma,
    Colon,
    /// A name, a number, a string or an attribute.
    Word(&'t str),
    /// `// ...`, without the line break.
    Line(&'t str),
    /// `/* ... */`.
    Block(&'t str),
}

/// A part, and the white space before it.
#[derive(Debug, Clone, Copy)]
struct Token<'t> {
    part: Part<'t>,
    /// Line breaks since the part before.
    breaks: usize,
    /// Blanks directly before it.
    blanks: usize,
}

/// A well-formed text in the layout of the project. The indent is four blanks for each bracket that is open
/// at the end of a line. One blank follows commas and colons. A comma follows the last entry before a
/// bracket on a line of its own. Lines have no trailing blanks, and there is at most one empty line in a
/// row. Line breaks, comments and the blanks before comments at the ends of lines stay as they are.
/// Formatting a formatted text changes nothing.
///
/// ```
/// let text = "(a:1 ,b :[\n1,2 // two\n ]\n)";
/// assert_eq!(ron_fields::formatted(text), "(a: 1, b: [\n    1, 2, // two\n],\n)\n");
/// ```
#[must_use]
pub fn formatted(text: &str) -> String {
    let tokens = tokens(text);
    let mut writer = Writer::default();
    for (at, token) in tokens.iter().enumerate() {
        let ends_entry =
            tokens[at + 1..].iter().find(|next| !matches!(next.part, Part::Line(_) | Part::Block(_)));
        let breaks_after = tokens[at + 1..]
            .iter()
            .take_while(|next| matches!(next.part, Part::Line(_) | Part::Block(_)))
            .chain(ends_entry)
            .any(|next| next.breaks > 0);
        writer.write(token);
        let is_last = ends_entry.is_some_and(|next| matches!(next.part, Part::Close(_))) && breaks_after;
        if is_last && matches!(token.part, Part::Word(_) | Part::Close(_)) && !writer.open.is_empty() {
            writer.text.push(',');
        }
    }
    writer.text + "\n"
}

#[derive(Default)]
struct Writer<'t> {
    text: String,
    /// For each open bracket, the indent of its line.
    open: Vec<usize>,
    /// Indent of the current line.
    indent: usize,
    last: Option<Part<'t>>,
}

impl<'t> Writer<'t> {
    fn write(&mut self, token: &Token<'t>) {
        let part = token.part;
        if self.last.is_some() && token.breaks > 0 {
            self.break_line(token);
        } else if self.last.is_some() {
            let blanks = self.blanks_before(token);
            self.text.extend(std::iter::repeat_n(' ', blanks));
        }
        match part {
            Part::Open(bracket) => {
                self.open.push(self.indent);
                self.text.push_str(bracket);
            }
            Part::Close(bracket) => {
                self.open.pop();
                self.text.push_str(bracket);
            }
            Part::Comma => self.text.push(','),
            Part::Colon => self.text.push(':'),
            Part::Word(text) | Part::Line(text) | Part::Block(text) => self.text.push_str(text),
        }
        self.last = Some(part);
    }

    fn break_line(&mut self, token: &Token) {
        let is_close = matches!(token.part, Part::Close(_));
        let is_after_open = matches!(self.last, Some(Part::Open(_)));
        self.text.push('\n');
        if token.breaks > 1 && !is_close && !is_after_open {
            self.text.push('\n');
        }
        let around = self.open.last().copied();
        self.indent = around.map_or(0, |around| around + usize::from(!is_close));
        self.text.extend(std::iter::repeat_n(' ', INDENT * self.indent));
    }

    fn blanks_before(&self, token: &Token) -> usize {
        match (self.last, token.part) {
            (_, Part::Line(_)) => token.blanks.max(1),
            (_, Part::Comma | Part::Colon | Part::Close(_))
            | (Some(Part::Open(_)), _)
            | (Some(Part::Word(_)), Part::Open(_)) => 0,
            _ => 1,
        }
    }
}

fn tokens(text: &str) -> Vec<Token<'_>> {
    let (mut cursor, mut tokens) = (Cursor::new(text), Vec::new());
    let (mut breaks, mut blanks) = (0, 0);
    while let Some(byte) = cursor.peek() {
        if byte.is_ascii_whitespace() {
            breaks += usize::from(byte == b'\n');
            blanks = if byte == b'\n' { 0 } else { blanks + 1 };
            cursor.advance();
            continue;
        }
        let start = cursor.at();
        let part = part(&mut cursor, byte, text, start);
        tokens.push(Token { part, breaks, blanks });
        (breaks, blanks) = (0, 0);
    }
    // Commas are written after the entry before them: a comma at the start of a line moves to the line
    // before.
    for at in 1..tokens.len() {
        if tokens[at].part == Part::Comma {
            let moved = std::mem::replace(&mut tokens[at].breaks, 0);
            if let Some(next) = tokens.get_mut(at + 1) {
                next.breaks = next.breaks.max(moved);
            }
        }
    }
    after_commas(&mut tokens);
    tokens
}

/// Puts commas before the comments between an entry and its comma, and drops commas that [`formatted`] adds
/// itself.
fn after_commas(tokens: &mut Vec<Token>) {
    let mut at = 0;
    while at < tokens.len() {
        let is_comment = |token: &Token| matches!(token.part, Part::Line(_) | Part::Block(_));
        let mut place = at;
        while tokens[at].part == Part::Comma && place > 0 && is_comment(&tokens[place - 1]) {
            place -= 1;
        }
        if place < at {
            let comma = tokens.remove(at);
            tokens.insert(place, comma);
        }
        at += 1;
    }
    let mut keep: Vec<bool> = vec![true; tokens.len()];
    for at in 0..tokens.len() {
        let after =
            tokens[at + 1..].iter().position(|next| !matches!(next.part, Part::Line(_) | Part::Block(_)));
        let closes = after.is_some_and(|after| matches!(tokens[at + 1 + after].part, Part::Close(_)));
        keep[at] = !(tokens[at].part == Part::Comma && closes);
    }
    let mut kept = keep.into_iter();
    tokens.retain(|_| kept.next().unwrap_or(true));
}

fn part<'t>(cursor: &mut Cursor<'t>, byte: u8, text: &'t str, start: usize) -> Part<'t> {
    let rest = &text[start..];
    match byte {
        b'(' | b'[' | b'{' => {
            cursor.advance();
            Part::Open(cursor.since(start))
        }
        b')' | b']' | b'}' => {
            cursor.advance();
            Part::Close(cursor.since(start))
        }
        b',' => {
            cursor.advance();
            Part::Comma
        }
        b':' => {
            cursor.advance();
            Part::Colon
        }
        b'/' if rest.starts_with("//") => {
            let end = rest.find('\n').unwrap_or(rest.len());
            cursor.go_back(start + end);
            Part::Line(rest[..end].trim_end())
        }
        b'/' if rest.starts_with("/*") => {
            cursor.skip_block_comment();
            Part::Block(cursor.since(start))
        }
        b'"' | b'\'' => {
            cursor.quoted(byte);
            Part::Word(cursor.since(start))
        }
        b'#' if rest.starts_with("#!") => {
            cursor.go_back(start + rest.find(']').map_or(rest.len(), |end| end + 1));
            Part::Word(cursor.since(start))
        }
        _ => {
            word(cursor, rest);
            Part::Word(cursor.since(start))
        }
    }
}

/// Steps over a name, a number, or a string with a prefix.
fn word(cursor: &mut Cursor, rest: &str) {
    let raw = rest.trim_start_matches('b');
    let hashes = raw.strip_prefix('r').map(|raw| raw.trim_start_matches('#'));
    if hashes.is_some_and(|raw| raw.starts_with('"')) && rest.len() - raw.len() < 2 {
        (0..=rest.len() - raw.len()).for_each(|_| cursor.advance());
        return cursor.raw_string();
    }
    if let Some(quote @ (b'"' | b'\'')) = rest.strip_prefix('b').and_then(|rest| rest.bytes().next()) {
        cursor.advance();
        return cursor.quoted(quote);
    }
    cursor.advance();
    while cursor.peek().is_some_and(|byte| !byte.is_ascii_whitespace() && !b",:()[]{}/\"'".contains(&byte)) {
        cursor.advance();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Fields, check_syntax};

    #[test]
    fn indents_blanks_and_commas_are_set_and_comments_stay() {
        let text = "#![enable(implicit_some)]\n( // start\n\n\n a:1,b : \"x, y\" ,\n   // on its own\n \
            list:[(at:(1 ,2)),\n\n\n  Disc( 0.5 )   // aligned\n ],raw:r#\"a\n  b\"#\n, /* in */ \
            map:{\"k\":[1\n,2]}\n\n)\n// end";
        let expected = "#![enable(implicit_some)]\n( // start\n\n    a: 1, b: \"x, y\",\n    // on its \
            own\n    list: [(at: (1, 2)),\n\n        Disc(0.5),   // aligned\n    ], raw: r#\"a\n  \
            b\"#,\n    /* in */ map: {\"k\": [1,\n        2]},\n)\n// end\n";
        assert_eq!(formatted(text), expected);
        assert_eq!(formatted(expected), expected, "twice is as once");
    }

    #[test]
    fn the_values_are_the_same_and_the_text_is_well_formed() {
        for text in [
            "1",
            "()",
            "[]",
            "(a: [ ],)",
            "(a: Some((b: \"c\")))",
            "(a: 1 // one\n, b: 2\n)",
            "[1, 2 /* two */\n]",
            "A(\"x\")",
            "(größe: -1e3)",
        ] {
            let out = formatted(text);
            assert_eq!(check_syntax(&out), Ok(()), "{text}: {out}");
            let leaves = |text: &str| -> Vec<(String, String)> {
                Fields::of(text)
                    .leaves()
                    .map(|(path, place)| (path.to_owned(), text[place].replace(' ', "")))
                    .collect()
            };
            assert_eq!(leaves(text), leaves(&out), "{text}: {out}");
            assert_eq!(formatted(&out), out, "{text}");
        }
    }
}
