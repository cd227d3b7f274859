//! Ranges of numbers, lengths of lists and patterns of names in the JSON Schema of scenario files.

use ron_tree::limits::Limit;
use serde_json::{Map, Value, json};

use super::{limits, ranges};

/// Patterns of names.
const PATTERNS: [(&str, &str); 9] = [
    ("name", "^[A-Za-z0-9_]([A-Za-z0-9._-]{0,62}[A-Za-z0-9_-])?$"),
    ("words.*", "^[a-z][a-z0-9]{0,23}$"),
    ("roles.*.name", PLAIN),
    ("needs.*.name", PLAIN),
    ("tasks.*.name", PLAIN),
    ("debris[*].name", LINE),
    ("walls[*].doors[*].name", LINE),
    ("radiation[*].name", LINE),
    ("timeline[*].event.name", LINE),
];

const PLAIN: &str = "^[A-Za-z0-9_][A-Za-z0-9_-]{0,63}$";
const LINE: &str = "^[^\\r\\n]{1,64}$";

/// Puts all ranges and patterns into a schema.
pub(super) fn put_ranges(schema: &mut Value) {
    ranges::all().iter().for_each(|(path, limit)| put_limit(schema, path, *limit));
    let format = f64::from(super::FORMAT);
    put_limit(schema, "format", Limit { least: format, most: format, ..limits::ROBOTS });
    for (path, pattern) in PATTERNS {
        for place in places(schema, path) {
            put_at(schema, &place, "pattern", json!(pattern));
        }
    }
}

fn put_at(schema: &mut Value, place: &str, key: &str, value: Value) {
    if let Some(own) = schema.pointer_mut(place).and_then(Value::as_object_mut) {
        own.insert(key.to_owned(), value);
    }
}

/// Puts a limit at the places of a path. Of two limits of a length, the narrower one counts.
fn put_limit(schema: &mut Value, path: &str, limit: Limit) {
    for place in places(schema, path) {
        let own = schema.pointer(&place).and_then(Value::as_object);
        let Some((least_key, most_key)) = own.and_then(keys) else { continue };
        let is_length = least_key != "minimum";
        let there = |key: &str| own?.get(key)?.as_f64().filter(|_| is_length);
        let least = there(least_key).map_or(limit.least, |there| there.max(limit.least));
        let most = there(most_key).map_or(limit.most, |there| there.min(limit.most));
        if !is_length || least > 0.0 {
            put_at(schema, &place, least_key, number(least));
        }
        put_at(schema, &place, most_key, number(most));
    }
}

/// The keywords for the least and the greatest value of a schema of this type.
fn keys(schema: &Map<String, Value>) -> Option<(&'static str, &'static str)> {
    let is_tuple = schema.contains_key("prefixItems");
    let kind = match schema.get("type")? {
        Value::Array(kinds) => kinds.first()?.as_str()?,
        kind => kind.as_str()?,
    };
    match kind {
        "number" | "integer" => Some(("minimum", "maximum")),
        "array" if !is_tuple => Some(("minItems", "maxItems")),
        "object" if !schema.contains_key("properties") => Some(("minProperties", "maxProperties")),
        _ => None,
    }
}

/// Whole numbers are written without a point.
fn number(value: f64) -> Value {
    if value.fract() == 0.0 { json!(value as i64) } else { json!(value) }
}

/// The places of a path in a schema, as JSON pointers.
fn places(schema: &Value, path: &str) -> Vec<String> {
    let path = path.replace("[*]", ".[]");
    let mut places = vec![String::new()];
    for part in path.split('.') {
        places = places.iter().flat_map(|place| step(schema, place, part)).collect();
    }
    places.iter().flat_map(|place| opened(schema, place)).collect()
}

/// The schemas that a place stands for: those of its reference and of its alternatives, and itself.
fn opened(schema: &Value, place: &str) -> Vec<String> {
    let Some(own) = schema.pointer(place).and_then(Value::as_object) else { return Vec::new() };
    let mut all = vec![place.to_owned()];
    let reference = own.get("$ref").and_then(Value::as_str).and_then(|to| to.strip_prefix('#'));
    all.extend(reference.into_iter().flat_map(|to| opened(schema, to)));
    for key in ["anyOf", "oneOf", "allOf"] {
        let count = own.get(key).and_then(Value::as_array).map_or(0, Vec::len);
        all.extend((0..count).flat_map(|i| opened(schema, &format!("{place}/{key}/{i}"))));
    }
    all
}

/// The places of a part of a path below a place: a field, `*` for all fields or entries, `[]` for entries.
fn step(schema: &Value, place: &str, part: &str) -> Vec<String> {
    let mut found = Vec::new();
    for place in opened(schema, place) {
        let Some(own) = schema.pointer(&place).and_then(Value::as_object) else { continue };
        if part == "*" || part == "[]" {
            let inner = ["items", "additionalProperties"].into_iter();
            let inner = inner.filter(|key| own.get(*key).is_some_and(Value::is_object));
            found.extend(inner.map(|key| format!("{place}/{key}")));
            let count = own.get("prefixItems").and_then(Value::as_array).map_or(0, Vec::len);
            found.extend((0..count).map(|i| format!("{place}/prefixItems/{i}")));
        }
        for name in own.get("properties").and_then(Value::as_object).into_iter().flat_map(Map::keys) {
            let inner = format!("{place}/properties/{name}");
            if ranges::matches(part, name) {
                found.push(inner);
            } else if name.starts_with(|c: char| c.is_ascii_uppercase()) {
                found.extend(step(schema, &inner, part)); // into a variant
            }
        }
    }
    found
}
