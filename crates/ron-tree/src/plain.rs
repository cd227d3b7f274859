//! Texts for people: no character of them acts unseen, and they name no type of the program.

use std::borrow::Cow;

/// Whether a character acts instead of being seen: it would control a terminal, or change the direction in
/// which text is read.
pub fn is_unseen(c: char) -> bool {
    let turns = matches!(
        c,
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
    );
    (c.is_control() && c != '\n' && c != '\t') || turns
}

/// The text with every such character replaced by its number.
///
/// ```
/// assert_eq!(ron_tree::visible("ma\u{202e}nor"), "ma\\u{202e}nor");
/// ```
pub fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(is_unseen) {
        return Cow::Borrowed(text);
    }
    let escaped = |c: char| if is_unseen(c) { format!("\\u{{{:x}}}", c as u32) } else { c.to_string() };
    Cow::Owned(text.chars().map(escaped).collect())
}

/// Words before the name of a type, and what the type is in a file.
const TYPES: [(&str, &str); 3] =
    [("struct", "an object"), ("enum", "one of the known forms"), ("variant", "one of the known forms")];

/// Words that may stand before those.
const KINDS: [&str; 8] =
    ["tuple", "struct", "unit", "newtype", "untagged", "internally", "adjacently", "tagged"];

/// Names of the program's numbers, by their first letters, and what they are in a file.
fn number(word: &str) -> Option<&'static str> {
    let size = word.strip_prefix(['u', 'i', 'f'])?;
    let is_number = size == "size" || size.parse().is_ok_and(|bits: u8| bits.is_power_of_two() && bits >= 8);
    is_number.then_some(if word.starts_with('f') { "a number" } else { "a whole number" })
}

/// The message of an error of JSON without the names of the program's types.
///
/// ```
/// let message = "invalid type: integer `1`, expected struct TrialRecord at line 1 column 1";
/// let plain = "invalid type: integer `1`, expected an object at line 1 column 1";
/// assert_eq!(ron_tree::without_types(&message), plain);
/// ```
pub fn without_types(message: &impl ToString) -> String {
    let message = message.to_string();
    let mut plain: Vec<&str> = Vec::new();
    let mut words = message.split(' ').peekable();
    while let Some(word) = words.next() {
        let is_named = words.peek().is_some_and(|name| name.starts_with(char::is_uppercase));
        let Some((_, means)) = TYPES.iter().find(|(kind, _)| *kind == word && is_named) else {
            let is_expected = plain.last() == Some(&"expected");
            plain.push(number(word).filter(|_| is_expected).unwrap_or(word));
            continue;
        };
        words.next();
        while plain.last().is_some_and(|last| KINDS.contains(last)) {
            plain.pop();
        }
        plain.push(means);
    }
    plain.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_of_a_type_is_left() {
        for (message, plain) in [
            ("expected u32 at line 1", "expected a whole number at line 1"),
            ("expected struct World with 3 elements", "expected an object with 3 elements"),
            ("expected tuple variant Event::Fell", "expected one of the known forms"),
            ("expected struct variant Event::Fell", "expected one of the known forms"),
            (
                "did not match any variant of untagged enum Stored",
                "did not match any variant of one of the known forms",
            ),
            (
                "unknown variant `Struct`, expected `A` or `B`",
                "unknown variant `Struct`, expected `A` or `B`",
            ),
        ] {
            assert_eq!(without_types(&message), plain);
        }
    }

    #[test]
    fn unseen_characters_are_shown_by_number_and_others_stay() {
        assert_eq!(visible("a\u{61c}b\u{7}\tθ\n"), "a\\u{61c}b\\u{7}\tθ\n");
    }
}
