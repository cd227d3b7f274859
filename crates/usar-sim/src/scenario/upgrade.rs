//! Upgrading files of former formats to the present one.

use ron_fields::{Fields, formatted};

use super::{FORMAT, former};

/// Values of the paper's rule that format 1 had outside the rule.
const MOVED: [&str; 3] = ["margin_m", "horizon_s", "deadlock_steps"];

/// Rewrites the text of a file in the present format, with its comments. A change that a program cannot make
/// is returned as its line and the necessary change.
///
/// # Errors
/// The first field that a person has to change.
pub fn upgraded(text: &str) -> Result<String, (usize, String)> {
    let mut text = roles_in_quotes(text);
    text = values_of_the_rule(&text);
    text = with_format(&text);
    match former::change_needed(&text) {
        Some(found) => Err(found),
        None => Ok(formatted(&text)),
    }
}

/// Rewrites `role: Carrier` as `role: "carrier"`.
fn roles_in_quotes(text: &str) -> String {
    let fields = Fields::of(text);
    let rows = (0..fields.entries("team").unwrap_or_default()).rev();
    let mut out = text.to_owned();
    for place in rows.filter_map(|row| fields.value(&format!("team[{row}].role"))) {
        let name = &text[place.clone()];
        if name.starts_with(char::is_alphabetic) {
            out.replace_range(place, &format!("{:?}", name.to_lowercase()));
        }
    }
    out
}

/// Rewrites `conflicts: (margin_m: 0.2)` as `conflicts: (resolver: Rotation(margin_m: 0.2))`.
fn values_of_the_rule(text: &str) -> String {
    let fields = Fields::of(text);
    let mut values = Vec::new();
    let mut out = text.to_owned();
    let mut places: Vec<(&str, std::ops::Range<usize>)> =
        MOVED.iter().filter_map(|name| Some((*name, fields.value(&format!("conflicts.{name}"))?))).collect();
    places.sort_by_key(|(_, place)| std::cmp::Reverse(place.start));
    for (name, place) in places {
        values.insert(0, format!("{name}: {}", &text[place.clone()]));
        let start = text[..place.start].rfind(name).unwrap_or(place.start);
        let after = text[place.end..].trim_start();
        let end = if after.starts_with(',') { text.len() - after.len() + 1 } else { place.end };
        out.replace_range(start..end, "");
    }
    if values.is_empty() {
        return out;
    }
    let values = values.join(", ");
    let fields = Fields::of(&out);
    match (fields.value("conflicts.resolver"), fields.value("conflicts")) {
        (Some(place), _) => {
            let rule = out[place.clone()].trim().to_owned();
            let takes_values = ["Rotation", "Swap"].contains(&rule.as_str());
            out.replace_range(place, &if takes_values { format!("{rule}({values})") } else { rule });
        }
        // In format 1, the default was the paper's rule.
        (None, Some(place)) => out.insert_str(place.start + 1, &format!("resolver: Rotation({values}), ")),
        (None, None) => {}
    }
    out
}

/// Sets the number of the format, as the first field if there is none yet.
fn with_format(text: &str) -> String {
    let fields = Fields::outer(text);
    let mut out = text.to_owned();
    if let Some(place) = fields.value("format") {
        out.replace_range(place, &FORMAT.to_string());
        return out;
    }
    let first = fields.inside("").into_iter().filter_map(|name| Some((name, fields.value(name)?.start)));
    let Some((name, value)) = first.min_by_key(|(_, start)| *start) else { return out };
    let start = out[..value].rfind(name).unwrap_or(value);
    let line = out[..start].rfind('\n').map_or(0, |at| at + 1);
    let blanks: String = out[line..start].to_owned();
    let is_alone = blanks.trim().is_empty() && line > 0;
    let field = if is_alone { format!("format: {FORMAT},\n{blanks}") } else { format!("format: {FORMAT}, ") };
    out.insert_str(start, &field);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_format_1_is_rewritten_with_its_comments() {
        let text = "(\n    name: \"a\", // the name\n    team: [(role: Walker, count: 1)],\n    conflicts: \
            (priority: LowestEnergyFirst, margin_m: 0.2, // near\n        deadlock_steps: 9),\n)";
        let expected = "(\n    format: 2,\n    name: \"a\", // the name\n    team: [(role: \"walker\", \
            count: 1)],\n    conflicts: (resolver: Rotation(margin_m: 0.2, deadlock_steps: 9), priority: \
            LowestEnergyFirst,  // near\n    ),\n)\n";
        let out = upgraded(text).unwrap();
        assert_eq!(out, expected);
        assert_eq!(upgraded(&out).unwrap(), out);
    }

    #[test]
    fn what_a_person_has_to_change_is_told() {
        let (line, change) = upgraded("(name: \"a\",\n tasks: (near: (grid: (1, 1))))").unwrap_err();
        assert!(line == 3 || line == 2, "{line}");
        assert!(change.starts_with("tasks: is a list now"), "{change}");
    }
}
