//! `docs/scenarios-reference.md`, made from the comments of the types into which scenario and sweep files
//! are read.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

use serde_json::Value;

use crate::docs::{on_a_line, place};

const HEAD: &str = "\
# Reference of scenario files

Every field of a scenario and of a sweep file. A tutorial and examples are in [scenarios](scenarios.md); \
limits of
the numbers are in [limits](limits.md). In the place of a number may stand a
[distribution](scenarios.md#a-value-or-a-distribution).

The comments of the types are the source of this page: `cargo run --bin xtask -- reference` makes it, \
and a test
compares it with them.
";

/// Path of the page.
pub fn path() -> PathBuf {
    place("docs/scenarios-reference.md")
}

/// Text of the page.
pub fn page() -> String {
    let mut page = HEAD.to_owned();
    let scenario = scenario::scenario_schema();
    let sweep = experiments::experiment::sweep_schema();
    for (title, schema) in [("A scenario", &scenario), ("A sweep", &sweep)] {
        section(&mut page, title, schema);
    }
    let types = [&scenario, &sweep].into_iter().filter_map(|schema| schema["$defs"].as_object());
    let types: BTreeMap<&String, &Value> = types.flatten().collect();
    for (name, schema) in types {
        section(&mut page, name, schema);
    }
    page
}

/// The schemas of files, each with name and text.
pub fn schemas() -> [(&'static str, String); 2] {
    let text = |schema: &Value| serde_json::to_string_pretty(schema).expect("a schema is JSON") + "\n";
    [
        ("scenario", text(&scenario::scenario_schema())),
        ("sweep", text(&experiments::experiment::sweep_schema())),
    ]
}

fn text<'v>(schema: &'v Value, key: &str) -> &'v str {
    schema.get(key).and_then(Value::as_str).unwrap_or_default()
}

/// Writes the section of a type: its fields, or its variants.
fn section(page: &mut String, title: &str, schema: &Value) {
    let _ = write!(page, "\n## {title}\n\n{}\n", cell(schema));
    let variants = schema.get("oneOf").or(schema.get("anyOf")).and_then(Value::as_array);
    if let Some(fields) = schema.get("properties").and_then(Value::as_object) {
        let required = required(schema);
        page.push_str("\n| field | is | default | |\n| --- | --- | --- | --- |\n");
        for (name, field) in fields {
            let default = match field.get("default") {
                _ if required.contains(&name.as_str()) => "must be given".to_owned(),
                Some(value @ Value::Array(_)) if value.to_string().len() > 40 => {
                    "see `usar scenario resolve`".to_owned()
                }
                Some(value @ Value::Object(fields)) if !fields.is_empty() => {
                    let short = value.to_string();
                    if short.len() < 40 { format!("`{short}`") } else { "each has its own".to_owned() }
                }
                Some(Value::Null) | None => String::new(),
                Some(value) => format!("`{value}`"),
            };
            let _ = writeln!(page, "| `{name}` | {} | {default} | {} |", kind(field), cell(field));
        }
    } else if let Some(variants) =
        variants.filter(|all| all.iter().all(|one| one.get("description").is_some()))
    {
        page.push_str("\n| variant | |\n| --- | --- |\n");
        for variant in variants {
            let _ = writeln!(page, "| `{}` | {} |", variant_name(variant), cell(variant));
        }
    }
}

/// The required fields; for a scenario, those required without a base.
fn required(schema: &Value) -> Vec<&str> {
    let of_alternatives = || schema.get("anyOf")?.as_array()?.last()?.get("required");
    let list = schema.get("required").or_else(of_alternatives).and_then(Value::as_array);
    list.into_iter().flatten().filter_map(Value::as_str).collect()
}

fn variant_name(variant: &Value) -> String {
    let named = variant.get("const").and_then(Value::as_str);
    named.map_or_else(
        || {
            let fields = variant.get("properties").and_then(Value::as_object).into_iter().flatten();
            let inside = |of: &Value| match of.get("properties").and_then(Value::as_object) {
                Some(fields) => {
                    let fields: Vec<String> = fields
                        .iter()
                        .map(|(name, field)| format!("{name}: {}", plain(&kind(field))))
                        .collect();
                    fields.join(", ")
                }
                None => plain(&kind(of)),
            };
            fields.map(|(name, of)| format!("{name}({})", inside(of))).collect::<Vec<_>>().join(" ")
        },
        str::to_owned,
    )
}

fn plain(kind: &str) -> String {
    let unlinked: Vec<&str> = kind.split(['[', ']']).collect();
    match unlinked[..] {
        [before, name, after] => {
            format!("{before}{name}{}", after.split_once(')').map_or("", |(_, rest)| rest))
        }
        _ => kind.to_owned(),
    }
}

/// The type of a value, with a link to its section.
fn kind(schema: &Value) -> String {
    if let Some(name) = schema.get("$ref").and_then(Value::as_str).and_then(|path| path.rsplit('/').next()) {
        return format!("[{name}](#{})", name.to_lowercase());
    }
    for alternatives in ["allOf", "anyOf", "oneOf"] {
        if let Some(first) = schema.get(alternatives).and_then(Value::as_array).and_then(|all| all.first()) {
            return kind(first);
        }
    }
    let items = || schema.get("items").map_or_else(|| "values".to_owned(), kind);
    let kind = match schema.get("type") {
        Some(Value::Array(types)) => types.first().and_then(Value::as_str),
        other => other.and_then(Value::as_str),
    };
    match kind {
        Some("array") => match (
            schema.get("maxItems").and_then(Value::as_u64),
            schema.get("prefixItems").and_then(Value::as_array),
        ) {
            (_, Some(items)) => items.iter().map(self::kind).collect::<Vec<_>>().join(", "),
            (Some(2), None) => format!("({0}, {0})", items()),
            _ => format!("list of {}", items()),
        },
        Some("object") => match schema.get("additionalProperties") {
            Some(of @ Value::Object(_)) => format!("map of {}", self::kind(of)),
            _ => "map".to_owned(),
        },
        Some("integer") => "count".to_owned(),
        Some("string") => "text".to_owned(),
        Some("boolean") => "true or false".to_owned(),
        Some(other) => other.to_owned(),
        None => "value".to_owned(),
    }
}

/// A comment as a cell of a table.
fn cell(schema: &Value) -> String {
    on_a_line(text(schema, "description")).replace('|', "\\|")
}
