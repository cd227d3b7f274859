//! Paths such as `tasks.hard.grid[0]`.

/// Splits off the first segment: `tasks.hard[0]` is split into `tasks` and `.hard[0]`, and that into
/// `.hard` and `[0]`. Dots and brackets in quotes belong to the key of a map.
pub(crate) fn split(path: &str) -> (&str, &str) {
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
pub(crate) fn is_segment(name: &str) -> bool {
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
