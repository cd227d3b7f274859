//! Values with names: `values: (leak_m: 4.5)`, and then `radius_m: leak_m` wherever that value is meant.
//!
//! Before a text is read, each name that stands alone in place of a value is replaced by its value, on the
//! same line. A scenario over a base uses the names of its base. It may give a name another value, which then
//! counts in the base too.

use std::collections::BTreeMap;

use ron_fields::file::MAX_TEXT_BYTES;
use ron_fields::{Fields, nearest};

use super::error::Problem;
use crate::limits;

/// The field that holds the names and their values.
const FIELD: &str = "values";

/// Words of RON that are not names.
const WORDS: [&str; 4] = ["true", "false", "inf", "r"];

/// Names and the texts of their values, each on one line.
pub(super) type Names = BTreeMap<String, String>;

/// Whether a text has the field `values`.
pub(super) fn are_in(text: &str) -> bool {
    text.contains(FIELD) && Fields::outer(text).value(FIELD).is_some()
}

/// The names that a text defines, and the problems with them.
pub(super) fn names(text: &str) -> (Names, Vec<Problem>) {
    let (mut names, mut problems) = (Names::new(), Vec::new());
    if !are_in(text) {
        return (names, problems);
    }
    let fields = Fields::of(text);
    let mut wrong = |field: String, rule: &str, found: &str| {
        let (line, rule, found) = (fields.line(&field), rule.to_owned(), found.to_owned());
        problems.push(Problem { field, line, rule, found, ..Problem::default() });
    };
    let place = fields.value(FIELD).unwrap_or_default();
    if !text[place.clone()].starts_with('(') {
        wrong(FIELD.to_owned(), "must be names with their values, as in (leak_m: 4.5)", &text[place]);
        return (names, problems);
    }
    for name in fields.inside(FIELD) {
        let field = format!("{FIELD}.{name}");
        let value = &text[fields.value(&field).unwrap_or_default()];
        if !is_name(name) {
            wrong(field, "must have a name of small letters, digits and _, from a letter on", name);
        } else if !limits::VALUE_BYTES.allows(value.len()) {
            let most = limits::VALUE_BYTES.most;
            wrong(field, &format!("must be at most {most} bytes long"), &format!("{} bytes", value.len()));
        } else if value.contains('\n') {
            wrong(field, "must stand on one line", value.lines().next().unwrap_or_default());
        } else if names.contains_key(name) {
            wrong(field, "must not be given twice", value);
        } else {
            names.insert(name.to_owned(), value.to_owned());
        }
    }
    for (field, inside) in fields.leaves().filter(|(_, inside)| place.contains(&inside.start)) {
        if names.contains_key(&text[inside.clone()]) {
            wrong(field.to_owned(), "must be a value, not the name of another", &text[inside]);
        }
    }
    if !limits::VALUES.allows(names.len()) {
        let found = names.len().to_string();
        wrong(FIELD.to_owned(), &format!("must be at most {}", limits::VALUES.most), &found);
    }
    (names, problems)
}

/// Whether a word is a name, and not a variant or a word of RON.
fn is_name(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_lowercase())
        && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
        && !WORDS.contains(&word)
}

/// A text without its field `values`, in which each name is replaced by its value. Lines keep their numbers.
///
/// # Errors
/// The text would exceed the size that is read.
pub(super) fn expanded(text: &str, names: &Names) -> Result<String, Box<Problem>> {
    let fields = Fields::of(text);
    let own = fields.value(FIELD).unwrap_or_default();
    let mut out = String::with_capacity(text.len());
    let mut from = 0;
    for (_, place) in fields.leaves() {
        let Some(value) = names.get(&text[place.clone()]).filter(|_| !own.contains(&place.start)) else {
            continue;
        };
        out.push_str(&text[from..place.start]);
        out.push_str(value);
        from = place.end;
        if out.len() as u64 > MAX_TEXT_BYTES {
            let rule = format!("must not make the file longer than {} MiB", MAX_TEXT_BYTES >> 20);
            return Err(Box::new(Problem { field: FIELD.to_owned(), rule, ..Problem::default() }));
        }
    }
    out.push_str(&text[from..]);
    Ok(without_names(&out))
}

/// Blanks the field `values` with the comma after it.
fn without_names(text: &str) -> String {
    let Some(place) = Fields::outer(text).value(FIELD) else { return text.to_owned() };
    let start = text[..place.start].rfind(FIELD).unwrap_or(place.start);
    let rest = text[place.end..].trim_start();
    let end = if rest.starts_with(',') { text.len() - rest.len() + 1 } else { place.end };
    let blank: String = text[start..end].chars().map(|c| if c == '\n' { '\n' } else { ' ' }).collect();
    [&text[..start], &blank, &text[end..]].concat()
}

/// Adds a hint with the most similar name to a problem with an unknown word.
pub(super) fn hint(problem: &mut Problem, names: &Names) {
    if names.is_empty() || !problem.hint.is_empty() || !is_name(&problem.found) {
        return;
    }
    let known = || names.keys().map(String::as_str);
    problem.hint = match nearest(&problem.found, known()) {
        Some(meant) => format!("did you mean {meant}?"),
        None => format!("no value has this name; {FIELD} has {}", known().collect::<Vec<_>>().join(", ")),
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_gives_way_to_its_value_and_nothing_else_changes() {
        let text = "(values: (far: (1, 2), low: 0.5), // names\n name: \"far\", at: far, x: [low, low_ , \
            far],\n far: Disc(low))";
        let (names, problems) = names(text);
        assert_eq!(problems, []);
        let text = expanded(text, &names).unwrap();
        let expected = " // names\n name: \"far\", at: (1, 2), x: [0.5, low_ , (1, 2)],\n far: Disc(0.5))";
        assert_eq!(text.trim_start_matches(['(', ' ']), expected.trim_start());
        assert_eq!(text.lines().count(), 3);
    }

    #[test]
    fn what_is_no_name_or_no_value_is_told() {
        for (text, says) in [
            ("(values: 3)", "must be names with their values"),
            ("(values: [1])", "must be names with their values"),
            ("(values: (Far: 3))", "must have a name of small letters"),
            ("(values: (true: 3))", "must have a name of small letters"),
            ("(values: (a: 3, a: 4))", "must not be given twice"),
            ("(values: (a: [1,\n2]))", "must stand on one line"),
            ("(values: (a: 1, b: [a]))", "must be a value, not the name of another"),
        ] {
            let (_, problems) = names(text);
            assert!(problems.len() == 1 && problems[0].rule.contains(says), "{text}: {problems:?}");
        }
    }

    #[test]
    fn many_uses_of_a_long_value_are_refused_early() {
        let value = format!("\"{}\"", "x".repeat(1000));
        let text = format!("(values: (a: {value}), list: [{}])", "a,".repeat(1 << 20));
        let problem = expanded(&text, &names(&text).0).unwrap_err();
        assert_eq!(problem.rule, "must not make the file longer than 4 MiB");
    }
}
