//! Errors about values that do not fit their fields, in terms of the file.

use ron::error::Error;

use crate::{Fields, nearest};

/// The rule that a field breaks which does not exist.
pub(crate) const NO_FIELD: &str = "is no field";

/// A value that does not fit its field.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Misfit {
    /// Path of the field; empty for the whole text.
    pub field: String,
    /// The rule for the value, as the rest of a sentence: `must be a whole number`.
    pub rule: String,
    /// The value in the text; empty if there is none.
    pub found: String,
    /// A hint at what may have been meant; empty without one.
    pub hint: String,
}

impl Misfit {
    /// Converts the deserialiser's error in a well-formed text, with the path and the byte at which it
    /// occurred.
    #[must_use]
    pub fn new(error: &Error, path: &str, (text, at): (&str, usize), fields: &Fields) -> Self {
        let is_of_value = matches!(error, Error::ExpectedComma | Error::ExpectedStructLikeEnd);
        let number = if is_of_value {
            fields.leaf_at(at).filter(|leaf| is_within_number(text, fields, leaf, at))
        } else {
            None
        };
        let is_whole = number.is_some_and(|leaf| !value(text, fields, leaf).contains(['.', 'e', 'E']));
        let field = number.filter(|_| !is_whole).unwrap_or_else(|| written(path, fields)).to_owned();
        let found = shown(value(text, fields, &field));
        let within = |name: &str| match field.as_str() {
            "" => name.to_owned(),
            path => format!(
                "{}.{name}",
                path.strip_suffix(name).and_then(|path| path.strip_suffix('.')).unwrap_or(path)
            ),
        };
        let plain = |rule: &str| Self {
            field: field.clone(),
            rule: rule.to_owned(),
            found: found.clone(),
            hint: String::new(),
        };
        match error {
            Error::NoSuchStructField { expected, found: name, .. } => {
                let field = if field == *name { field } else { within(name) };
                Self { field, rule: NO_FIELD.to_owned(), hint: meant(name, expected), found: String::new() }
            }
            Error::MissingStructField { field: name, .. } => {
                Self { field: within(name), rule: "must be given".to_owned(), ..Self::default() }
            }
            Error::DuplicateStructField { field: name, .. } => {
                Self { field: within(name), rule: "must not be given twice".to_owned(), ..Self::default() }
            }
            Error::NoSuchEnumVariant { expected, found: name, .. } => {
                let hint = nearest(name, expected.iter().copied());
                let hint = hint.map_or(String::new(), |meant| format!("did you mean {meant}?"));
                Self {
                    field,
                    rule: format!("must be one of {}", expected.join(", ")),
                    found: name.clone(),
                    hint,
                }
            }
            Error::ExpectedDifferentLength { expected, .. } => {
                let count: String = expected.chars().filter(char::is_ascii_digit).collect();
                plain(&format!("must have {count} entries"))
            }
            Error::Message(said) => match said.split(PARTS).collect::<Vec<_>>()[..] {
                [inner, rule, found, hint] => {
                    let field = if inner.is_empty() { field } else { within(inner) };
                    Self { field, rule: rule.to_owned(), found: found.to_owned(), hint: hint.to_owned() }
                }
                _ => plain(said),
            },
            _ if number.is_some() && !is_whole => plain("must be a whole number"),
            other => plain(&in_words(other, &found)),
        }
    }

    /// The misfit as one text that [`Misfit::new`] can take apart again. Used for values that are read
    /// separately from their text.
    #[must_use]
    pub fn packed(&self) -> String {
        [self.field.as_str(), &self.rule, &self.found, &self.hint].join(PARTS)
    }
}

/// Separator between the parts of a packed misfit.
const PARTS: &str = "\u{1f}";

/// A hint with the name that was probably meant, and the known names.
fn meant(name: &str, known: &[&str]) -> String {
    let there = if known.is_empty() {
        "there are none".to_owned()
    } else {
        format!("there are {}", known.join(", "))
    };
    nearest(name, known.iter().copied())
        .map_or(there.clone(), |meant| format!("did you mean {meant}? {}", there.replacen('t', "T", 1)))
}

/// The part of a path that the text has. The deserialiser's path may continue inside a value.
fn written<'p>(path: &'p str, fields: &Fields) -> &'p str {
    let mut path = path.trim_end_matches(['?', '.']);
    while !path.is_empty() && fields.value(path).is_none() {
        path = &path[..path.rfind(['.', '[']).unwrap_or(0)];
    }
    path
}

fn value<'t>(text: &'t str, fields: &Fields, path: &str) -> &'t str {
    fields.value(path).and_then(|place| text.get(place)).unwrap_or_default()
}

/// Whether a byte lies in a number, after its beginning.
fn is_within_number(text: &str, fields: &Fields, leaf: &str, at: usize) -> bool {
    is_number(value(text, fields, leaf)) && fields.value(leaf).is_some_and(|place| place.start < at)
}

fn is_number(text: &str) -> bool {
    text.parse::<f64>().is_ok()
}

/// A value as a message quotes it: on one line, and shortened.
fn shown(value: &str) -> String {
    let line = value.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.chars().count() <= 60 { line } else { line.chars().take(60).chain("...".chars()).collect() }
}

fn in_words(error: &Error, found: &str) -> String {
    let is_whole = !found.contains(['.', 'e', 'E']) && is_number(found);
    match error {
        Error::IntegerOutOfBounds if found.starts_with('-') => "must be a whole number of at least 0",
        Error::IntegerOutOfBounds if is_whole => "must be a smaller whole number",
        Error::ExpectedInteger | Error::IntegerOutOfBounds | Error::InvalidIntegerDigit { .. } => {
            "must be a whole number"
        }
        Error::ExpectedFloat | Error::FloatUnderscore => "must be a number",
        Error::ExpectedBoolean => "must be true or false",
        Error::ExpectedString | Error::ExpectedStringEnd => "must be a text in double quotes",
        Error::ExpectedIdentifier | Error::SuggestRawIdentifier(_) | Error::InvalidIdentifier(_) => {
            "must be a name without quotes"
        }
        Error::ExpectedArray => "must be a list in square brackets: [...]",
        Error::ExpectedMap => "must be a map in curly brackets: {\"name\": ...}",
        Error::ExpectedStructLike
        | Error::ExpectedNamedStructLike(_)
        | Error::ExpectedStructName(_)
        | Error::ExpectedUnit => "must be in round brackets: (...)",
        Error::ExpectedStructLikeEnd | Error::ExpectedComma => "has an entry too many",
        other => return format!("cannot be read: {other}"),
    }
    .to_owned()
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::*;

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields)]
    #[expect(dead_code, reason = "only reading is tested")]
    struct Row {
        count: u32,
        kind: Option<Kind>,
        #[serde(default)]
        place: [f64; 2],
        #[serde(default)]
        name: String,
        #[serde(default)]
        list: Vec<bool>,
    }

    #[derive(Debug, Deserialize)]
    #[expect(dead_code, reason = "only reading is tested")]
    enum Kind {
        Ground,
        Disc(f64),
    }

    fn misfit(text: &str, path: &str) -> String {
        let options =
            ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
        let error = options.from_str::<Row>(text).unwrap_err();
        let at = error.span.start.col - 1;
        let Misfit { field, rule, found, hint } =
            Misfit::new(&error.code, path, (text, at), &Fields::of(text));
        format!("{field} {rule}, {found}; {hint}")
    }

    #[test]
    fn each_misfit_is_told_in_words_of_the_file() {
        for (text, path, told) in [
            ("(count: 3.5)", "?", "count must be a whole number, 3.5; "),
            ("(count: -3)", "count", "count must be a whole number of at least 0, -3; "),
            ("(count: 99999999999)", "count", "count must be a smaller whole number, 99999999999; "),
            ("(count: six)", "count", "count must be a whole number, six; "),
            (
                "(coutn: 3)",
                "coutn",
                "coutn is no field, ; did you mean count? There are count, kind, place, name, list",
            ),
            ("(colour: 3)", "colour", "colour is no field, ; there are count, kind, place, name, list"),
            ("(place: (1, 2))", ".", "count must be given, ; "),
            ("(count: 1, count: 2)", ".", "count must not be given twice, ; "),
            (
                "(count: 1, kind: Disk(2))",
                "kind",
                "kind must be one of Ground, Disc, Disk; did you mean Disc?",
            ),
            ("(count: 1, kind: \"Ground\")", "kind", "kind must be a name without quotes, \"Ground\"; "),
            ("(count: 1, kind: Disc(a))", "kind.Disc", "kind must be a number, Disc(a); "),
            ("(count: 1, place: (1))", "place", "place must have 2 entries, (1); "),
            ("(count: 1, place: (1, 2, 3))", "place", "place has an entry too many, (1, 2, 3); "),
            ("(count: 1, place: 3)", "place", "place must be in round brackets: (...), 3; "),
            ("(count: 1, name: x)", "name", "name must be a text in double quotes, x; "),
            ("(count: 1, list: 1)", "list", "list must be a list in square brackets: [...], 1; "),
            ("(count: 1, list: [1])", "list[0]", "list[0] must be true or false, 1; "),
        ] {
            assert_eq!(misfit(text, path), told, "{text}");
        }
    }
}
