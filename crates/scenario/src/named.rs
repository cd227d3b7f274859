//! Values with names: `values: (leak_m: 4.5)`, and then `radius_m: leak_m` wherever that value is meant.
//!
//! Before a tree is read, each name that stands alone in place of a value is replaced by its value. A
//! scenario over a base uses the names of its base. It may give a name another value, which then counts in
//! the base too.

use std::collections::BTreeMap;

use ron_tree::file::MAX_TEXT_BYTES;
use ron_tree::{Node, Problem, Value, nearest};

use crate::limits;

/// The field that holds the names and their values.
const FIELD: &str = "values";

/// Words of RON that are not names.
const WORDS: [&str; 4] = ["true", "false", "inf", "r"];

/// Names and their values.
pub(super) type Names = BTreeMap<String, Node>;

/// Takes the names that a tree defines out of it. Returns them and the problems with them.
pub(super) fn take_out(root: &mut Node) -> (Names, Vec<Problem>) {
    let (mut names, mut problems) = (Names::new(), Vec::new());
    let Some(section) = root.remove(FIELD) else { return (names, problems) };
    let mut wrong = |field: String, rule: &str, found: String, node: &Node| {
        let line = Some(node.place.line as usize);
        problems.push(Problem { line, ..Problem::new(field, rule, found) });
    };
    let is_section = match &section.value {
        Value::Struct(name, _) => name.is_empty(),
        Value::Tuple(name, entries) => name.is_empty() && entries.is_empty(),
        _ => false,
    };
    if !is_section {
        let rule = "must be names with their values, as in (leak_m: 4.5)";
        wrong(FIELD.to_owned(), rule, section.to_string(), &section);
    }
    for (name, value) in section.fields() {
        let (name, bytes) = (name.to_string(), value.bytes().len());
        let field = format!("{FIELD}.{name}");
        if !is_name(&name) {
            wrong(field, "must have a name of small letters, digits and _, from a letter on", name, value);
        } else if !limits::VALUE_BYTES.allows(bytes) {
            let rule = format!("must be at most {} bytes long", limits::VALUE_BYTES.most);
            wrong(field, &rule, format!("{bytes} bytes"), value);
        } else {
            names.insert(name, value.clone());
        }
    }
    for (path, leaf) in section.leaves() {
        if leaf.as_word().is_some_and(|word| names.contains_key(word)) {
            let rule = "must be a value, not the name of another";
            wrong(format!("{FIELD}.{path}"), rule, leaf.to_string(), leaf);
        }
    }
    if !limits::VALUES.allows(names.len()) {
        let rule = format!("must be at most {}", limits::VALUES.most);
        wrong(FIELD.to_owned(), &rule, names.len().to_string(), &section);
    }
    (names, problems)
}

/// Whether a word is a name, and not a variant or a word of RON.
fn is_name(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_lowercase())
        && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
        && !WORDS.contains(&word)
}

/// Replaces each name in a tree by its value, at the place of the name.
///
/// # Errors
/// The text would exceed the size that is read.
pub(super) fn expand(root: &mut Node, names: &Names) -> Result<(), Box<Problem>> {
    let mut budget = (MAX_TEXT_BYTES as usize).saturating_sub(root.bytes().len());
    let is_small = names.is_empty() || expand_within(root, names, &mut budget);
    if is_small {
        return Ok(());
    }
    let rule = format!("must not make the file longer than {} MiB", MAX_TEXT_BYTES >> 20);
    Err(Box::new(Problem::new(FIELD, rule, "")))
}

/// Replaces names as long as the budget of bytes allows it; returns whether it did.
fn expand_within(node: &mut Node, names: &Names, budget: &mut usize) -> bool {
    let Some(value) = node.as_word().and_then(|word| names.get(word)) else {
        return node.children_mut().into_iter().all(|(_, child)| expand_within(child, names, budget));
    };
    let bytes = value.bytes().len();
    if bytes > *budget {
        return false;
    }
    *budget -= bytes;
    let place = node.place;
    *node = value.clone();
    node.put_at(place);
    true
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

    fn tree(text: &str) -> Node {
        Node::parse(text).unwrap()
    }

    #[test]
    fn a_name_gives_way_to_its_value_and_nothing_else_changes() {
        let mut root = tree(
            "(values: (far: (1, 2), low: 0.5), // names\n name: \"far\", at: far, x: [low, low_ , far],\n \
             far: Disc(low))",
        );
        let (names, problems) = take_out(&mut root);
        assert_eq!(problems, []);
        expand(&mut root, &names).unwrap();
        assert_eq!(root, tree("(name: \"far\", at: (1, 2), x: [0.5, low_ , (1, 2)], far: Disc(0.5))"));
        assert_eq!(root.line("far[0]"), Some(3));
    }

    #[test]
    fn what_is_no_name_or_no_value_is_told() {
        for (text, says) in [
            ("(values: 3)", "must be names with their values"),
            ("(values: [1])", "must be names with their values"),
            ("(values: (1, 2))", "must be names with their values"),
            ("(values: (Far: 3))", "must have a name of small letters"),
            ("(values: (true: 3))", "must have a name of small letters"),
            ("(values: (a: 1, b: [a]))", "must be a value, not the name of another"),
        ] {
            let (_, problems) = take_out(&mut tree(text));
            assert!(problems.len() == 1 && problems[0].rule.contains(says), "{text}: {problems:?}");
        }
    }

    #[test]
    fn many_uses_of_a_long_value_are_refused_early() {
        let value = format!("\"{}\"", "x".repeat(1000));
        let mut root = tree(&format!("(values: (a: {value}), list: [{}])", "a,".repeat(1 << 15)));
        let (names, _) = take_out(&mut root);
        let problem = expand(&mut root, &names).unwrap_err();
        assert_eq!(problem.rule, "must not make the file longer than 4 MiB");
    }
}
