//! Files in the former format: they are refused with a message that says how to change them.

use ron_fields::Fields;

/// The first field in the former format, with its line and its replacement.
pub(super) fn change_needed(text: &str) -> Option<(usize, String)> {
    let fields = Fields::of(text);
    let value = |path: &str| fields.value(path).map(|place| text[place].trim_start());
    let is_struct = |path: &str| value(path).is_some_and(|value| value.starts_with('('));
    let is_bare =
        |path: &str| value(path).is_some_and(|value| value.starts_with(|c: char| c.is_alphabetic()));
    let found = |path: &str, change: &str| Some((fields.line(path)?, format!("{path}: {change}")));
    if value("sweep").is_some() {
        return found(
            "sweep",
            "belongs in a sweep file now: move it to NAME.sweep.ron beside NAME.ron, as \
             `(scenario: \"NAME.ron\", policies: [...], trials: ...)`",
        );
    }
    if value("rne").is_some() {
        return found(
            "rne",
            "belongs to the policy now: write `policies: [\"RNE(score: Sum)\"]` in a sweep file, or \
             `--policy 'RNE(score: Sum)'`",
        );
    }
    if is_struct("roles") {
        return found(
            "roles",
            "is a list now: write `roles: [(name: \"...\", kind: Ground, ...), ...]`; `kind: Aerial` for \
             robots that fly, `guides: true` for those whose loss slows their group",
        );
    }
    if is_struct("tasks") {
        return found(
            "tasks",
            "is a list now: write `tasks: [(name: \"...\", difficulty: 2, center: ...), ...]`; the harder a \
             task, the higher its difficulty",
        );
    }
    if is_bare("team[0].role") {
        return found("team[0].role", "is the name of a role now: write it in quotes, as in `roles`");
    }
    if let Some(name) = ["margin_m", "horizon_s", "deadlock_steps"]
        .into_iter()
        .find(|name| value(&format!("conflicts.{name}")).is_some())
    {
        let change = format!(
            "belongs to the paper's rule now: write `conflicts: (resolver: Rotation({name}: ...))`; other \
             resolvers have no use for it"
        );
        return found(&format!("conflicts.{name}"), &change);
    }
    let moved = fields
        .inside("sampled")
        .into_iter()
        .find(|name| is_struct(&format!("sampled.{name}")) && !name.ends_with("_m"))?;
    found(
        &format!("sampled.{moved}"),
        "belongs to the task now: write `sampled: (debris: ..., radiation: ...)` in its entry of `tasks`",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_field_of_the_former_format_is_named_with_its_line_and_the_change() {
        for (text, line, start) in [
            ("(\n sweep: (trials: 3))", 2, "sweep: belongs in a sweep file now"),
            ("(name: \"a\",\n\n rne: (sort: true))", 3, "rne: belongs to the policy now"),
            ("(roles: (walker: (hp: 1.0)))", 1, "roles: is a list now"),
            ("(tasks: (near: (grid: (1, 1))))", 1, "tasks: is a list now"),
            ("(team: [\n(role: Walker, count: 1)])", 2, "team[0].role: is the name of a role now"),
            (
                "(conflicts: (\nhorizon_s: 1.0, resolver: None))",
                2,
                "conflicts.horizon_s: belongs to the paper's rule now",
            ),
            ("(sampled: (\nnear: (debris: 1), gap_m: 2.0))", 2, "sampled.near: belongs to the task now"),
        ] {
            let (found, change) = change_needed(text).unwrap();
            assert!(found == line && change.starts_with(start), "{found}: {change}");
        }
        let new = "(roles: [(name: \"walker\")], team: [(role: \"walker\")], tasks: [(name: \"near\")], \
            sampled: (gap_m: 1.0))";
        assert_eq!(change_needed(new), None);
    }
}
