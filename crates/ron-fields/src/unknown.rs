//! Errors about paths that do not exist.

use crate::fields::{Fields, ROOT, Step};
use crate::nearest;
use crate::path::split;
use crate::set::SetError;

/// Largest number of entry names in a message.
const MAX_NAMES: usize = 20;

impl Fields {
    /// The error for a path that is none of these fields. `what` describes the whole text, for example
    /// `the file`.
    #[must_use]
    pub fn unknown(&self, path: &str, what: &str) -> SetError {
        let mut trail = self.trail(path).into_iter().rev();
        let told = trail.find_map(|step| {
            let known = self.known(step.node)?;
            Some((step, known))
        });
        let (Step { node, end }, known) =
            told.unwrap_or((Step { node: ROOT, end: 0 }, "no fields".to_owned()));
        let within = if end == 0 { what } else { &path[..end] };
        let (word, _) = split(path[end..].trim_start_matches('.'));
        let there = self.names_in(node).into_iter().chain(self.names_of_entries(node));
        let meant = nearest(word, there).map(str::to_owned);
        SetError::Unknown { path: path.to_owned(), within: within.to_owned(), known, meant }
    }

    /// The content of a node in words; `None` for a number or a string.
    fn known(&self, node: usize) -> Option<String> {
        let names = self.names_in(node);
        if !names.is_empty() {
            return Some(names.join(", "));
        }
        let entries = self.names_of_entries(node);
        match (self.entries_in(node), entries.is_empty()) {
            (0, _) => self.nodes[node].is_list.then(|| "no entries".to_owned()),
            (1, true) => Some("1 entry, [0]".to_owned()),
            (count, true) => Some(format!("{count} entries, from [0] on")),
            (1, false) => Some(format!("{} (or [0])", list(&entries))),
            (count, false) => Some(format!("{} (or [0] to [{}])", list(&entries), count - 1)),
        }
    }

    /// Names of entries in the order of the list.
    fn names_of_entries(&self, node: usize) -> Vec<&str> {
        let mut names: Vec<(usize, &str)> = self.nodes[node]
            .named
            .iter()
            .flat_map(|named| named.iter())
            .map(|(name, entry)| (*entry, &**name))
            .collect();
        names.sort_unstable();
        names.into_iter().map(|(_, name)| name).collect()
    }
}

fn list(names: &[&str]) -> String {
    let shown = names[..names.len().min(MAX_NAMES)].join(", ");
    match names.len().saturating_sub(MAX_NAMES) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_there_instead_is_told() {
        let text = r#"(
            tasks: [(name: "hard", grid: (1, 2), steps: [(name: "go")]), (name: "easy"), (name: "hard")],
            debris: [1, 2], one: [1], none: [], speed: 3,
        )"#;
        let fields = Fields::of(text);
        for (path, says) in [
            ("tasks.medium", "tasks has hard, easy (or [0] to [2])"),
            ("tasks.medium.grid[0]", "tasks has hard, easy (or [0] to [2])"),
            ("tasks[3]", "tasks has hard, easy (or [0] to [2])"),
            ("tasks.hard.steps.fly", "tasks.hard.steps has go (or [0])"),
            ("tasks.hard.size", "tasks.hard has name, grid, steps"),
            ("tasks.hard.grid[2]", "tasks.hard.grid has 2 entries, from [0] on"),
            ("debris[7].at", "debris has 2 entries, from [0] on"),
            ("debris.large", "debris has 2 entries, from [0] on"),
            ("one[1]", "one has 1 entry, [0]"),
            ("none.any", "none has no entries"),
            ("speed.x", "the file has tasks, debris, one, none, speed"),
            ("sped", "the file has tasks, debris, one, none, speed"),
            ("", "the file has tasks, debris, one, none, speed"),
        ] {
            let error = fields.unknown(path, "the file").to_string();
            assert!(error.starts_with(&format!("{path}: no such field; {says}")), "{error}");
        }
        let error = fields.unknown("tasks.hadr.grid", "the file").to_string();
        assert!(error.ends_with("(or [0] to [2]); did you mean hard?"), "{error}");
        let error = Fields::of("3").unknown("a", "the number").to_string();
        assert_eq!(error, "a: no such field; the number has no fields");
    }

    #[test]
    fn many_names_are_cut_short() {
        let entries: Vec<String> = (0..22).map(|i| format!("(name: \"n{i}\")")).collect();
        let error = Fields::of(&format!("[{}]", entries.join(", "))).unknown("x", "the list").to_string();
        assert!(error.starts_with("x: no such field; the list has n0, n1, n2, "), "{error}");
        assert!(error.ends_with(", n19 and 2 more (or [0] to [21])"), "{error}");
    }
}
