//! The layout of a text: indents, blanks, commas at ends of lines. Line breaks and comments stay unchanged.

use crate::Malformed;
use crate::parse::{self, Part, parse};
use crate::print::INDENT;

/// A part, and the white space before it.
#[derive(Debug, Clone, Copy)]
struct Token<'t> {
    part: Part,
    text: &'t str,
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
/// # Errors
/// The first place that is not well-formed, or that exceeds a [limit](mod@crate::limits).
///
/// ```
/// let text = "(a:1 ,b :[\n1,2 // two\n ]\n)";
/// assert_eq!(ron_tree::formatted(text)?, "(a: 1, b: [\n    1, 2, // two\n],\n)\n");
/// # Ok::<(), ron_tree::Malformed>(())
/// ```
pub fn formatted(text: &str) -> Result<String, Malformed> {
    let tokens = tokens(text, &parse(text)?.1);
    let mut writer = Writer::default();
    for (at, token) in tokens.iter().enumerate() {
        let ends_entry = tokens[at + 1..].iter().find(|next| !matches!(next.part, Part::Line | Part::Block));
        let breaks_after = tokens[at + 1..]
            .iter()
            .take_while(|next| matches!(next.part, Part::Line | Part::Block))
            .chain(ends_entry)
            .any(|next| next.breaks > 0);
        writer.write(token);
        let is_last = ends_entry.is_some_and(|next| matches!(next.part, Part::Close)) && breaks_after;
        if is_last && matches!(token.part, Part::Word | Part::Close) && !writer.open.is_empty() {
            writer.text.push(',');
        }
    }
    Ok(writer.text + "\n")
}

#[derive(Default)]
struct Writer {
    text: String,
    /// For each open bracket, the indent of its line.
    open: Vec<usize>,
    /// Indent of the current line.
    indent: usize,
    last: Option<Part>,
}

impl Writer {
    fn write(&mut self, token: &Token) {
        let part = token.part;
        if self.last.is_some() && token.breaks > 0 {
            self.break_line(token);
        } else if self.last.is_some() {
            let blanks = self.blanks_before(token);
            self.text.extend(std::iter::repeat_n(' ', blanks));
        }
        match part {
            Part::Open => self.open.push(self.indent),
            Part::Close => drop(self.open.pop()),
            Part::Comma | Part::Colon | Part::Word | Part::Line | Part::Block => {}
        }
        self.text.push_str(token.text);
        self.last = Some(part);
    }

    fn break_line(&mut self, token: &Token) {
        let is_close = matches!(token.part, Part::Close);
        let is_after_open = matches!(self.last, Some(Part::Open));
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
            (_, Part::Line) => token.blanks.max(1),
            (_, Part::Comma | Part::Colon | Part::Close)
            | (Some(Part::Open), _)
            | (Some(Part::Word), Part::Open) => 0,
            _ => 1,
        }
    }
}

fn tokens<'t>(text: &'t str, parts: &[parse::Token]) -> Vec<Token<'t>> {
    let (mut tokens, mut end) = (Vec::with_capacity(parts.len()), 0);
    for part in parts {
        let before = &text[end..part.start];
        let blanks = before.len() - before.rfind('\n').map_or(0, |at| at + 1);
        let (breaks, text) = (before.matches('\n').count(), text[part.start..part.end].trim_end());
        tokens.push(Token { part: part.part, text, breaks, blanks });
        end = part.end;
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
        let is_comment = |token: &Token| matches!(token.part, Part::Line | Part::Block);
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
        let after = tokens[at + 1..].iter().position(|next| !matches!(next.part, Part::Line | Part::Block));
        let closes = after.is_some_and(|after| matches!(tokens[at + 1 + after].part, Part::Close));
        keep[at] = !(tokens[at].part == Part::Comma && closes);
    }
    let mut kept = keep.into_iter();
    tokens.retain(|_| kept.next().unwrap_or(true));
}

#[cfg(test)]
mod tests {
    use crate::Node;

    fn formatted(text: &str) -> String {
        super::formatted(text).unwrap()
    }

    #[test]
    fn indents_blanks_and_commas_are_set_and_comments_stay() {
        let text = "( // start\n\n\n a:1,b : \"x, y\" ,\n   // on its own\n \
            list:[(at:(1 ,2)),\n\n\n  Disc( 0.5 )   // aligned\n ],raw:r#\"a\n  b\"#\n, /* in */ \
            map:{\"k\":[1\n,2]}\n\n)\n// end";
        let expected = "( // start\n\n    a: 1, b: \"x, y\",\n    // on its \
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
            assert_eq!(Node::parse(text), Node::parse(&out), "{text}: {out}");
            assert_eq!(formatted(&out), out, "{text}");
        }
    }
}
