//! Replaces values in the text of a file.

use std::ops::Range;

use crate::node::Node;
use crate::problem::Problem;

/// A value, and the bytes that it replaces.
struct Change<'a> {
    bytes: Range<usize>,
    path: &'a str,
    value: &'a str,
}

/// The text of a file with the values of these fields replaced. Each setting is a path and a value in RON.
/// Everything else, including comments, stays unchanged. The types of the values are not checked here, but
/// when the text is read.
///
/// # Errors
/// A field is not in the text or is set twice, or a value is not exactly one value.
pub fn edited(text: &str, settings: &[(String, String)]) -> Result<String, Box<Problem>> {
    let root = Node::parse(text).map_err(|error| Problem::new("", error.to_string(), ""))?;
    let changes = settings.iter().map(|(path, value)| change(&root, path, value.trim()));
    let mut changes = changes.collect::<Result<Vec<Change>, _>>()?;
    changes.sort_by_key(|change| change.bytes.start);
    if let Some([_, twice]) = changes.array_windows().find(|[a, b]| a.bytes.end > b.bytes.start) {
        let rule = "is set twice, by itself or as a part of another field";
        return Err(Box::new(Problem::new(twice.path, rule, "")));
    }
    let mut text = text.to_owned();
    changes.into_iter().rev().for_each(|change| text.replace_range(change.bytes, change.value));
    Ok(text)
}

fn change<'a>(root: &Node, path: &'a str, value: &'a str) -> Result<Change<'a>, Box<Problem>> {
    let Some(node) = root.get(path).filter(|_| !path.is_empty()) else {
        let problem = Problem::new(path, "is not written in the file", "");
        return Err(Box::new(problem.with_hint("write it there, so that its value can take its place")));
    };
    value_of(path, value)?;
    Ok(Change { bytes: node.bytes(), path, value })
}

/// The tree of the value of a field, given as a text of its own.
///
/// # Errors
/// The text is not exactly one value. It is quoted as given.
pub fn value_of(path: &str, text: &str) -> Result<Node, Box<Problem>> {
    let parsed = Node::parse(text).ok().filter(|node| text[node.bytes()].trim() == text.trim());
    let mut node = parsed.ok_or_else(|| {
        let problem = Problem::new(path, "must be one value in RON", text.trim());
        Box::new(problem)
    })?;
    node.put_at(crate::Place::default());
    Ok(node)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(text: &str, settings: &[(&str, &str)]) -> Result<String, String> {
        let settings: Vec<(String, String)> =
            settings.iter().map(|(path, value)| ((*path).to_owned(), (*value).to_owned())).collect();
        edited(text, &settings).map_err(|error| error.to_string())
    }

    #[test]
    fn values_take_their_places_and_comments_stay() {
        let text = "(\n    a: 1.0, // one\n    b: (c: [2.0, 3.0]), // two\n)";
        let expected = "(\n    a: 0.25, // one\n    b: (c: [2.0, 9.5]), // two\n)";
        assert_eq!(with(text, &[("b.c[1]", "9.5"), ("a", "0.25")]).unwrap(), expected);
        let twice = [("a", "10.25"), ("a", "12.125")];
        assert!(with(text, &twice).unwrap_err().starts_with("a is set twice"));
        let within = [("b", "(c: [])"), ("b.c[0]", "1.0")];
        assert!(with(text, &within).unwrap_err().starts_with("b.c[0] is set twice"));
        assert!(with(text, &[("d", "1")]).unwrap_err().starts_with("d is not written"));
        assert_eq!(with(text, &[("a", "1, z: 2")]).unwrap_err(), "a must be one value in RON, found 1, z: 2");
    }

    #[test]
    fn a_comment_right_after_a_value_stays() {
        let text = "(a: Fast /* as can be */, b: Slow // at the end\n)";
        let expected = "(a: Slow /* as can be */, b: Fast // at the end\n)";
        assert_eq!(with(text, &[("a", "Slow"), ("b", " Fast ")]).unwrap(), expected);
    }

    #[test]
    fn entries_are_written_by_their_names() {
        let text = "(tasks: [(name: \"hard\", grid: (1, 2)), (name: \"easy\", grid: (3, 4))]) // two";
        let expected = "(tasks: [(name: \"hard\", grid: (1, 8)), (name: \"easy\", grid: (9, 4))]) // two";
        assert_eq!(
            with(text, &[("tasks.easy.grid[0]", "9"), ("tasks.hard.grid[1]", "8")]).unwrap(),
            expected
        );
        let twice = [("tasks.easy.grid", "(0, 0)"), ("tasks[1].grid", "(0, 0)")];
        assert!(with(text, &twice).unwrap_err().contains("is set twice"));
    }
}
