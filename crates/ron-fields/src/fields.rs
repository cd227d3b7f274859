//! The fields of a text, looked up by path.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::path::split;

/// The node of the whole text.
pub(crate) const ROOT: usize = 0;

/// The places of a text's fields: the line of each field, so that an error can name the line to correct,
/// and the bytes of its value, so that the value can be replaced.
///
/// RON's deserialiser gives positions only for its own errors. `Fields` walks a text that is already known
/// to be well-formed.
///
/// A path is `tasks[0].grid[1]`. If a list's entry has a field `name` whose value is the string `"hard"`,
/// the path `tasks.hard.grid[1]` is valid, too. If two entries have the same name, it refers to the first.
/// The key of a map appears in a path as in the text: `map."a.b"`.
#[derive(Debug, Clone)]
pub struct Fields {
    /// The whole text, then its fields and entries in the order of the text, each before its own fields and
    /// entries.
    pub(crate) nodes: Vec<Node>,
    /// All nodes except the whole text, sorted by path; nodes with the same path are in the order of the
    /// text.
    pub(crate) index: Vec<u32>,
}

/// A field or an entry of a list.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    /// Path such as `tasks[0].grid[0]`.
    pub(crate) path: Box<str>,
    /// Line, from 1.
    line: usize,
    /// Bytes of its value.
    pub(crate) value: Range<usize>,
    /// Fields and entries directly in the node.
    pub(crate) children: Vec<u32>,
    /// Its entries that have a name, by name.
    #[expect(clippy::box_collection, reason = "most nodes have none, and there are many nodes")]
    pub(crate) named: Option<Box<BTreeMap<Box<str>, usize>>>,
    /// Value of its field `name`, used during the walk.
    pub(crate) name: Option<Box<str>>,
    /// Whether its value is in square brackets.
    pub(crate) is_list: bool,
}

impl Node {
    /// A node whose value is not known yet.
    pub(crate) fn new(path: Box<str>, line: usize, start: usize) -> Self {
        Self {
            path,
            line,
            value: start..start,
            children: Vec::new(),
            named: None,
            name: None,
            is_list: false,
        }
    }
}

/// The existing beginning of a path.
pub(crate) struct Step {
    /// The node at its end.
    pub(crate) node: usize,
    /// Bytes of the path up to here.
    pub(crate) end: usize,
}

impl Fields {
    /// The path with indices instead of names, `tasks[0].grid[1]` for `tasks.hard.grid[1]`, if the field
    /// exists.
    #[must_use]
    pub fn canonical(&self, path: &str) -> Option<String> {
        self.field(path).map(|field| field.path.to_string())
    }

    /// The bytes of a field's value, if the text has the field.
    #[must_use]
    pub fn value(&self, path: &str) -> Option<Range<usize>> {
        self.field(path).map(|field| field.value.clone())
    }

    /// All fields without fields of their own: the path of each, with indices instead of names, and the
    /// bytes of its value.
    pub fn leaves(&self) -> impl Iterator<Item = (&str, Range<usize>)> {
        let leaves = self.nodes.iter().skip(1).filter(|node| node.children.is_empty());
        leaves.map(|node| (&*node.path, node.value.clone()))
    }

    /// All fields and entries: the path of each, with indices instead of names, and the bytes of its value.
    /// Each comes before its own fields and entries.
    pub fn all(&self) -> impl Iterator<Item = (&str, Range<usize>)> {
        self.nodes.iter().skip(1).map(|node| (&*node.path, node.value.clone()))
    }

    /// The path, with indices instead of names, of the field without fields of its own whose value contains
    /// a byte of the text or ends directly before it.
    #[must_use]
    pub fn leaf_at(&self, at: usize) -> Option<&str> {
        self.leaves().find(|(_, place)| place.start <= at && at <= place.end).map(|(path, _)| path)
    }

    /// Number of entries of a list in the text; of the whole text for an empty path.
    #[must_use]
    pub fn entries(&self, path: &str) -> Option<usize> {
        self.find(path).map(|node| self.entries_in(node))
    }

    /// Names of the fields directly in a field; of the whole text for an empty path.
    #[must_use]
    pub fn inside(&self, path: &str) -> Vec<&str> {
        self.find(path).map(|node| self.names_in(node)).unwrap_or_default()
    }

    /// Line (from 1) of a field such as `tasks.hard.grid[0]`; if the text lacks the field, the line of the
    /// nearest enclosing field.
    #[must_use]
    pub fn line(&self, path: &str) -> Option<usize> {
        let nearest = || self.trail(path).last().map_or(ROOT, |step| step.node);
        let node = self.exactly(path).unwrap_or_else(nearest);
        (node != ROOT).then(|| self.nodes[node].line)
    }

    fn field(&self, path: &str) -> Option<&Node> {
        self.find(path).filter(|node| *node != ROOT).map(|node| &self.nodes[node])
    }

    /// The first node with exactly this path.
    fn exactly(&self, path: &str) -> Option<usize> {
        let first = self.index.partition_point(|node| *self.nodes[*node as usize].path < *path);
        let node = *self.index.get(first)? as usize;
        (*self.nodes[node].path == *path).then_some(node)
    }

    /// The node of a path with names or indices.
    fn find(&self, path: &str) -> Option<usize> {
        let by_steps = || self.trail(path).pop().filter(|step| step.end == path.len()).map(|step| step.node);
        self.exactly(path).or_else(by_steps)
    }

    /// The existing steps of a path, from the whole text inwards.
    pub(crate) fn trail(&self, path: &str) -> Vec<Step> {
        let mut trail = vec![Step { node: ROOT, end: 0 }];
        let (mut node, mut rest) = (ROOT, path);
        while !rest.is_empty() {
            let (segment, after) = split(rest);
            let Some(next) = self.step(node, segment) else { break };
            (node, rest) = (next, after);
            trail.push(Step { node, end: path.len() - rest.len() });
        }
        trail
    }

    /// The node of a segment within a node: the field or entry with this key, or else the first entry with
    /// this name.
    fn step(&self, node: usize, segment: &str) -> Option<usize> {
        let around = &self.nodes[node];
        let by_name = || {
            let name = if node == ROOT { segment } else { segment.strip_prefix('.')? };
            around.named.as_ref()?.get(name).copied()
        };
        let path = format!("{}{segment}", around.path);
        self.exactly(&path).or_else(by_name)
    }

    pub(crate) fn entries_in(&self, node: usize) -> usize {
        self.keys(node).filter(|key| key.starts_with('[')).count()
    }

    pub(crate) fn names_in(&self, node: usize) -> Vec<&str> {
        let names = self.keys(node).filter(|key| !key.starts_with('['));
        names.map(|key| key.strip_prefix('.').unwrap_or(key)).collect()
    }

    /// The keys of the fields and entries directly in a node: `.name` (at the root, `name`) or `[0]`.
    fn keys(&self, node: usize) -> impl Iterator<Item = &str> {
        let node = &self.nodes[node];
        node.children.iter().map(|child| &self.nodes[*child as usize].path[node.path.len()..])
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
        assert_eq!(fields.line("map.\"a.b\"[7].deep"), Some(11));
        assert_eq!(fields.line("absent.deep"), None);
        assert_eq!(fields.value("absent.deep"), None);
        assert_eq!(fields.line(""), None);
        assert_eq!(fields.value(""), None);
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
        assert_eq!(fields.entries("list"), Some(2));
        assert_eq!(fields.entries("map.\"a.b\""), Some(2));
        assert_eq!(fields.entries("absent"), None);
    }

    #[test]
    fn a_field_that_stands_twice_is_told_twice() {
        let fields = Fields::of("(a: 1, b: 2, a: 3)");
        assert_eq!(fields.inside(""), ["a", "b", "a"]);
        assert_eq!(fields.value("a"), Some(4..5));
    }

    const NAMED: &str = r#"(
    tasks: [
        (name: "hard", grid: (4, 5), steps: [
            (cost: 1, name: "go"),
            (cost: 2, name: "lift"),
        ]),
        Some((grid: (6, 7), name: "easy")),
        Task(name: "hard", grid: (8, 9)),
        (name: "a.b", grid: (0, 0)),
        (name: Some("roof"), grid: (1, 1)), (name: "grid[0]"),
        (name: ""), (name: "q\"q"), (name: r"raw"), (name: 3), 1,
    ],
    site: (name: "hall", size: 3),
    pair: ((name: "left", x: 1), (name: "right", x: 2)),
)"#;

    #[test]
    fn entries_are_found_by_their_names() {
        let fields = Fields::of(NAMED);
        for (path, canonical, line, value) in [
            ("tasks.hard.grid[0]", "tasks[0].grid[0]", 3, "4"),
            ("tasks.easy.grid[1]", "tasks[1].grid[1]", 7, "7"),
            ("tasks.hard.steps.lift.cost", "tasks[0].steps[1].cost", 5, "2"),
            ("tasks[0].steps.go.cost", "tasks[0].steps[0].cost", 4, "1"),
            ("tasks.hard.steps[1].cost", "tasks[0].steps[1].cost", 5, "2"),
            ("tasks[2].grid[0]", "tasks[2].grid[0]", 8, "8"),
            ("tasks.roof.grid[1]", "tasks[4].grid[1]", 10, "1"),
            ("pair.right.x", "pair[1].x", 14, "2"),
        ] {
            assert_eq!(fields.canonical(path).as_deref(), Some(canonical));
            assert_eq!(fields.line(path), Some(line), "{path}");
            assert_eq!(&NAMED[fields.value(path).unwrap()], value, "{path}");
        }
        assert_eq!(fields.entries("tasks.hard.steps"), Some(2));
        assert_eq!(fields.inside("tasks.easy"), ["grid", "name"]);
        assert_eq!(fields.line("tasks.hard.steps.lift.weight"), Some(5));
    }

    #[test]
    fn only_plain_names_of_entries_are_names() {
        let fields = Fields::of(NAMED);
        let absent = [
            "tasks.a.b",
            "tasks.",
            "tasks.q\"q",
            "tasks.raw",
            "tasks.3",
            "tasks.grid[0]",
            "site.hall",
            "hard",
            "tasks..hard",
            ".tasks",
            "tasks.hard.",
            "tasks[hard]",
            "tasks.hard.go",
        ];
        for path in absent {
            assert_eq!(fields.canonical(path), None, "{path}");
        }
    }

    #[test]
    fn a_text_that_is_a_list_has_names_too() {
        let fields = Fields::of(r#"[(name: "a", x: 1), (name: "b", x: 2)]"#);
        assert_eq!(fields.canonical("b.x").as_deref(), Some("[1].x"));
        assert_eq!(fields.canonical(".b.x"), None);
        assert_eq!(fields.entries(""), Some(2));
    }

    #[test]
    fn large_texts_are_looked_up_as_small_ones() {
        let entry = |i: usize| format!("(name: \"robot {i}\", at: (1, 2))");
        let entries: Vec<String> = (0..20_000).map(entry).collect();
        let text = format!("(robots: [\n{}])", entries.join(",\n"));
        let fields = Fields::of(&text);
        for i in 0..20_000 {
            assert_eq!(fields.line(&format!("robots.robot {i}.at[1]")), Some(2 + i));
            assert_eq!(fields.line(&format!("robots[{i}].absent")), Some(2 + i));
        }
    }
}
