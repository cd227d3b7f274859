//! The JSON Schema of scenario files, from the types' own comments.

use std::borrow::Cow;

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Map, Value, json};

use super::distribution::{Amount, Distribution};
use super::file::{Door, Point, ResolverRule, RightOfWay, ScenarioFile, WallFile};
use super::schema_ranges::put_ranges;

impl JsonSchema for Amount {
    fn schema_name() -> Cow<'static, str> {
        "Amount".into()
    }

    /// Each has a range of its own.
    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({"type": "number"})
    }
}

impl JsonSchema for ResolverRule {
    fn schema_name() -> Cow<'static, str> {
        "ResolverRule".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let rule = generator.subschema_for::<RightOfWay>();
        let with_values = |name: &str, says: &str| {
            json!({"description": says, "type": "object", "properties": {name: rule}, "required": [name],
                "additionalProperties": false})
        };
        let plain = |name: &str, says: &str| json!({"description": says, "type": "string", "const": name});
        json_schema!({
            "description": "What resolves conflicts and deadlocks.",
            "oneOf": [
                plain("Reciprocal", "Reciprocal avoidance in the open, right of way in narrow passages, and \
                    pushing where a robot is stuck. The default."),
                plain("None", "Nothing: robots drive as they wish and bump into each other. For comparison."),
                plain("Rotation", "The paper's rule with its defaults."),
                plain("Swap", "The paper's Algorithm 6, literally, with its defaults."),
                with_values("Rotation", "The paper's rule: the head of a conflict set goes, the others stop. \
                    The order of a deadlocked set is rotated, head to tail."),
                with_values("Swap", "The paper's rule; the head of a deadlocked set changes places with the \
                    next in line: the paper's Algorithm 6, literally."),
            ],
        })
    }
}

impl JsonSchema for WallFile {
    fn schema_name() -> Cow<'static, str> {
        "WallFile".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (point, doors) = (generator.subschema_for::<Point>(), generator.subschema_for::<Vec<Door>>());
        json_schema!({
            "description": "A straight wall, with doors. Written `(from: (0, 0), to: (10, 0))`, or short \
                `((0, 0), (10, 0))`. The long form also takes `thickness_m`, its thickness in metres (0.2 \
                without it), and `doors`, a list of Door.",
            "anyOf": [
                {"type": "array", "items": point, "minItems": 2, "maxItems": 2},
                {"type": "object", "properties": {
                    "from": {"description": "Where its middle line begins.", "allOf": [point]},
                    "to": {"description": "Where its middle line ends.", "allOf": [point]},
                    "thickness_m": {"description": "Thickness, in metres.", "type": "number", "default": 0.2},
                    "doors": {"description": "Its doors, which are gaps.", "allOf": [doors], "default": []},
                }, "required": ["from", "to"], "additionalProperties": false},
            ],
        })
    }
}

/// The JSON Schema of a scenario file. Structs are objects, and lists and tuples are arrays. A distribution
/// may stand in place of any number, as `{"Uniform": [2, 5]}`. A scenario over a base gives only the fields
/// that differ.
pub fn scenario_schema() -> Value {
    let mut generator = SchemaSettings::draft2020_12().into_generator();
    generator.subschema_for::<Distribution>();
    let mut schema = Value::from(generator.into_root_schema_for::<ScenarioFile>());
    put_ranges(&mut schema);
    let all = schema.as_object_mut();
    let Some(all) = all else { return schema };
    if let Some(properties) = all.get_mut("properties").and_then(Value::as_object_mut) {
        let base = json!({"description": "Path of another scenario, from this file's folder, of which this \
            one says what differs.", "type": "string"});
        properties.insert("base".to_owned(), base);
        let values = json!({"description": "Values with names, as in `(leak_m: 4.5)`: a name then stands for \
            its value wherever that is meant. A scenario over a base may give a name of the base another \
            value.", "type": "object", "additionalProperties": true});
        properties.insert("values".to_owned(), values);
    }
    // Sections may be given in part, and a base supplies the fields that are left out.
    let required = all.remove("required").unwrap_or_default();
    let list = |(table, _): (&str, &str)| (table.to_owned(), json!({"type": "array"}));
    let lists: Map<String, Value> = TABLES.into_iter().map(list).collect();
    let whole = json!({"required": required, "properties": lists});
    all.insert("anyOf".to_owned(), json!([{"required": ["base"]}, whole]));
    if let Some(types) = all.get_mut("$defs").and_then(Value::as_object_mut) {
        for name in ["Normal", "Rates"] {
            types.get_mut(name).and_then(Value::as_object_mut).and_then(|own| own.remove("required"));
        }
        for (name, own) in types.iter_mut() {
            if name != "Distribution" {
                let_numbers_be_drawn(own);
            }
        }
    }
    all.get_mut("properties").into_iter().for_each(let_numbers_be_drawn);
    TABLES.into_iter().for_each(|(table, entry)| let_entries_be_named(all, table, entry));
    schema
}

/// Tables whose entries have names, each with the type of an entry.
const TABLES: [(&str, &str); 3] = [("roles", "RoleFile"), ("needs", "NeedFile"), ("tasks", "TaskFile")];

/// Allows a table to be an object with a part of each entry, by its name, as a scenario over a base has it.
fn let_entries_be_named(all: &mut Map<String, Value>, table: &str, entry: &str) {
    let mut part = all["$defs"][entry].clone();
    part.as_object_mut().and_then(|part| part.remove("required"));
    let Some(own) = all["properties"][table].as_object_mut() else { return };
    let mut list = Map::new();
    for key in ["type", "items", "minItems", "maxItems"] {
        list.extend(own.remove(key).map(|value| (key.to_owned(), value)));
    }
    own.insert("anyOf".to_owned(), json!([list, {"type": "object", "additionalProperties": part}]));
}

/// Allows a distribution in place of each number.
fn let_numbers_be_drawn(schema: &mut Value) {
    match schema {
        Value::Object(fields) => {
            let kind = fields.get("type").map(|kind| kind.get(0).unwrap_or(kind));
            let is_number = matches!(kind.and_then(Value::as_str), Some("number" | "integer"));
            if is_number && !fields.contains_key("anyOf") {
                if fields.get("format").is_some_and(|format| format == "uint32") {
                    fields.entry("maximum").or_insert(json!(u32::MAX));
                }
                let mut number = Map::new();
                for key in ["type", "format", "minimum", "maximum"] {
                    fields.remove(key).into_iter().for_each(|value| {
                        number.insert(key.to_owned(), value);
                    });
                }
                fields.insert("anyOf".to_owned(), json!([number, {"$ref": "#/$defs/Distribution"}]));
                return;
            }
            fields.values_mut().for_each(let_numbers_be_drawn);
        }
        Value::Array(entries) => entries.iter_mut().for_each(let_numbers_be_drawn),
        _ => {}
    }
}
