//! Looking nodes up by paths such as `tasks[0].grid[1]`. An entry of a list that has a field `name` is also
//! found by that name: `tasks.hard.grid[1]`. The key of a map stands in a path as in the text: `map."a.b"`.

use crate::nearest;
use crate::node::{Node, Value};
use crate::problem::{NO_FIELD, Problem};

/// Largest number of entry names in a message.
const MAX_NAMES: usize = 20;

/// The existing beginning of a path.
struct Trail<'n> {
    /// The nodes along it, from the root on, each with the bytes of the path up to it.
    nodes: Vec<(&'n Node, usize)>,
    /// The position of each node but the root in the one before.
    positions: Vec<usize>,
    /// Whether the whole path exists.
    is_whole: bool,
}

impl Node {
    /// The node of a path. It may stand in `Some(...)`.
    pub fn get(&self, path: &str) -> Option<&Self> {
        let trail = self.trail(path);
        trail.nodes.last().filter(|_| trail.is_whole).map(|(node, _)| *node)
    }

    /// The node of a path, to be changed.
    pub fn get_mut(&mut self, path: &str) -> Option<&mut Self> {
        let trail = self.trail(path);
        let positions = trail.is_whole.then_some(trail.positions)?;
        positions.into_iter().try_fold(self, |node, position| node.child_mut(position))
    }

    /// The path with indices instead of names, `tasks[0].grid[1]` for `tasks.hard.grid[1]`. The part that
    /// does not exist stays as it is.
    pub fn canonical(&self, path: &str) -> String {
        let trail = self.trail(path);
        let steps = trail.nodes.iter().zip(&trail.positions);
        let known: String = steps.map(|((node, _), position)| node.peeled().segment(*position)).collect();
        let end = trail.nodes.last().map_or(0, |(_, end)| *end);
        format!("{}{}", known.trim_start_matches('.'), &path[end..])
    }

    /// Line of a field; if it does not exist, that of the nearest enclosing field. `None` if that is the
    /// whole text, or comes from no text.
    pub fn line(&self, path: &str) -> Option<usize> {
        let nodes = self.trail(path).nodes;
        let line = nodes.get(1..)?.last()?.0.place.line as usize;
        (line > 0).then_some(line)
    }

    /// Names of the fields directly in the node.
    pub fn names(&self) -> Vec<String> {
        self.peeled().fields().iter().map(|(name, _)| name.to_string()).collect()
    }

    /// The nodes without nodes of their own, each with its path.
    pub fn leaves(&self) -> Vec<(String, &Self)> {
        let mut leaves = Vec::new();
        self.collect_leaves(String::new(), &mut leaves);
        leaves
    }

    fn collect_leaves<'n>(&'n self, path: String, leaves: &mut Vec<(String, &'n Self)>) {
        let node = self.peeled();
        let mut children = node.children().enumerate().peekable();
        if children.peek().is_none() {
            return leaves.push((path, node));
        }
        for (position, child) in children {
            let segment = node.segment(position);
            let segment = if path.is_empty() { segment.trim_start_matches('.') } else { &segment };
            child.collect_leaves(format!("{path}{segment}"), leaves);
        }
    }

    /// Puts a value in the place of a field. A field that does not exist is added to the struct around it:
    /// whether there is such a field is found when the tree is read. `what` describes the whole tree in
    /// messages, for example `a scenario`.
    ///
    /// # Errors
    /// There is no such field, and no struct for it.
    pub fn set(&mut self, path: &str, value: Self, what: &str) -> Result<(), Box<Problem>> {
        if let Some(node) = self.get_mut(path).filter(|_| !path.is_empty()) {
            *node = value;
            return Ok(());
        }
        let (around, name) = path.rsplit_once('.').unwrap_or(("", path));
        let fields = match self.get_mut(around).map(Self::peeled_mut) {
            Some(Self { value: Value::Struct(_, fields), .. }) if is_segment(name) => fields,
            _ => return Err(self.unknown(path, what)),
        };
        fields.push((Self { place: value.place, ..Self::word(name) }, value));
        Ok(())
    }

    /// Takes a field out with its name. Of an entry in round brackets, the field that has the brackets is
    /// taken out; an entry in square brackets stays, because the numbers of others depend on it. Returns the
    /// path of what was taken out.
    pub(crate) fn take_out(&mut self, path: &str) -> Option<String> {
        let trail = self.trail(path);
        let (mut positions, ends) = (trail.positions, trail.nodes);
        let is_tuple = |node: &Node| matches!(node.peeled().value, Value::Tuple(..));
        while !positions.is_empty() && ends.get(positions.len() - 1).is_some_and(|(node, _)| is_tuple(node)) {
            positions.pop();
        }
        let end = ends.get(positions.len())?.1;
        let last = positions.pop()?;
        let around = positions.into_iter().try_fold(self, |node, position| node.child_mut(position))?;
        match &mut around.peeled_mut().value {
            Value::Struct(_, fields) | Value::Map(fields) => drop(fields.remove(last)),
            _ => return None,
        }
        Some(path[..end].to_owned())
    }

    /// The problem of a path that does not exist. `what` describes the whole tree, for example `the file`.
    pub fn unknown(&self, path: &str, what: &str) -> Box<Problem> {
        let nodes = self.trail(path).nodes;
        let told = nodes.iter().rev().find_map(|(node, end)| Some((*node, *end, node.peeled().known()?)));
        let (node, end, known) = told.unwrap_or((self, 0, "no fields".to_owned()));
        let within = if end == 0 { what } else { &path[..end] };
        let (word, _) = split(path[end..].trim_start_matches('.'));
        let names = node.names();
        let there = names.iter().map(String::as_str).chain(node.names_of_entries());
        let meant = nearest(word, there).map_or(String::new(), |meant| format!("did you mean {meant}? "));
        let problem = Problem::new(path, NO_FIELD, "").with_hint(format!("{meant}{within} has {known}"));
        Box::new(Problem { line: self.line(path), ..problem })
    }

    /// What is in the node, in words; `None` for a number or a text.
    fn known(&self) -> Option<String> {
        let names = self.names();
        if !names.is_empty() {
            return Some(names.join(", "));
        }
        let entries: Vec<&str> = self.names_of_entries().collect();
        match (self.entries().len(), entries.is_empty()) {
            (0, _) => matches!(self.value, Value::List(_)).then(|| "no entries".to_owned()),
            (1, true) => Some("1 entry, [0]".to_owned()),
            (count, true) => Some(format!("{count} entries, from [0] on")),
            (1, false) => Some(format!("{} (or [0])", cut_short(&entries))),
            (count, false) => Some(format!("{} (or [0] to [{}])", cut_short(&entries), count - 1)),
        }
    }

    /// Different names of entries, in the order of the list.
    fn names_of_entries(&self) -> impl Iterator<Item = &str> {
        let entries = self.peeled().entries();
        let names = entries.iter().filter_map(Node::own_name).enumerate();
        names
            .filter(move |(at, name)| {
                !entries.iter().filter_map(Node::own_name).take(*at).any(|n| n == *name)
            })
            .map(|(_, name)| name)
    }

    /// The value of the field `name`, if it can stand in a path.
    fn own_name(&self) -> Option<&str> {
        let node = self.peeled();
        let Value::Struct(_, fields) = &node.value else { return None };
        let (_, name) = fields.iter().find(|(field, _)| field.as_word() == Some("name"))?;
        name.peeled().as_text().filter(|name| is_segment(name))
    }

    /// The existing beginning of a path.
    fn trail(&self, path: &str) -> Trail<'_> {
        let mut trail = Trail { nodes: vec![(self, 0)], positions: Vec::new(), is_whole: false };
        let (mut node, mut rest) = (self, path);
        while !rest.is_empty() {
            let (segment, after) = split(rest);
            let Some(position) = node.peeled().position(segment, rest.len() == path.len()) else {
                return trail;
            };
            let Some(child) = node.child(position) else { return trail };
            (node, rest) = (child, after);
            trail.positions.push(position);
            trail.nodes.push((node, path.len() - rest.len()));
        }
        Trail { is_whole: true, ..trail }
    }

    /// The position of a segment in the node: of the field with this name, or of the entry with this number
    /// or name.
    fn position(&self, segment: &str, is_first: bool) -> Option<usize> {
        if let Some(number) = segment.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            return number.parse().ok().filter(|number| *number < self.entries().len());
        }
        let name = if is_first { segment } else { segment.strip_prefix('.')? };
        let has_name = |key: &Node| match &key.value {
            Value::Word(word) => **word == *name,
            _ => key.to_string() == name,
        };
        let field = self.fields().iter().position(|(key, _)| has_name(key));
        field.or_else(|| self.entries().iter().position(|entry| entry.own_name() == Some(name)))
    }

    /// The segment of a position.
    fn segment(&self, position: usize) -> String {
        match self.fields().get(position) {
            Some((name, _)) => format!(".{name}"),
            None => format!("[{position}]"),
        }
    }
}

fn cut_short(names: &[&str]) -> String {
    let shown = names[..names.len().min(MAX_NAMES)].join(", ");
    match names.len().saturating_sub(MAX_NAMES) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

/// Splits off the first segment: `tasks.hard[0]` is split into `tasks` and `.hard[0]`, and that into
/// `.hard` and `[0]`. Dots and brackets in quotes belong to the key of a map.
fn split(path: &str) -> (&str, &str) {
    let (mut in_quotes, mut is_escaped) = (false, false);
    let mut ends = |at: usize, c: char| {
        if is_escaped {
            is_escaped = false;
            return false;
        }
        is_escaped = in_quotes && c == '\\';
        in_quotes ^= c == '"';
        at > 0 && !in_quotes && matches!(c, '.' | '[')
    };
    let end = path.char_indices().find(|&(at, c)| ends(at, c)).map_or(path.len(), |(at, _)| at);
    path.split_at(end)
}

/// Whether a name can be a segment of a path.
fn is_segment(name: &str) -> bool {
    !name.is_empty() && !name.contains(['.', '[', '"', '\\'])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_falls_into_its_segments() {
        for (path, segments) in [
            ("tasks.hard.grid[0]", vec!["tasks", ".hard", ".grid", "[0]"]),
            ("[0][1].a", vec!["[0]", "[1]", ".a"]),
            (r#"map."a.b\"[".c"#, vec!["map", r#"."a.b\"[""#, ".c"]),
            (r#""a.b"[1]"#, vec![r#""a.b""#, "[1]"]),
            ("größe..x", vec!["größe", ".", ".x"]),
            (r#"open."a.b"#, vec!["open", r#"."a.b"#]),
        ] {
            let mut rest = path;
            let mut found = Vec::new();
            while !rest.is_empty() {
                let (segment, after) = split(rest);
                found.push(segment);
                rest = after;
            }
            assert_eq!(found, segments, "{path}");
        }
    }
}
