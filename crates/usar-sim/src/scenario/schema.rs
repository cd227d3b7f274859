//! The JSON Schema of scenario files, from the types' own comments.

use std::borrow::Cow;

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Value, json};

use super::distribution::{Amount, Distribution};
use super::file::{Door, Point, ResolverRule, RightOfWay, ScenarioFile, WallFile};

impl JsonSchema for Amount {
    fn schema_name() -> Cow<'static, str> {
        "Amount".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let drawn = generator.subschema_for::<Distribution>();
        json_schema!({
            "description": "A number, or a distribution from which each thing draws its own.",
            "anyOf": [{"type": "number"}, drawn],
        })
    }
}

impl JsonSchema for ResolverRule {
    fn schema_name() -> Cow<'static, str> {
        "ResolverRule".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let rule = generator.subschema_for::<RightOfWay>();
        let with_values = |name: &str, description: &str| json!({"description": description, "type": "object", "properties": {name: rule}, "required": [name], "additionalProperties": false});
        let plain = |name: &str, description: &str| json!({"description": description, "type": "string", "const": name});
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
                {
                    "type": "object",
                    "properties": {
                        "from": {"description": "Where its middle line begins.", "allOf": [point]},
                        "to": {"description": "Where its middle line ends.", "allOf": [point]},
                        "thickness_m": {"description": "Thickness, in metres.", "type": "number", "default": 0.2},
                        "doors": {"description": "Its doors, which are gaps.", "allOf": [doors], "default": []},
                    },
                    "required": ["from", "to"],
                    "additionalProperties": false,
                },
            ],
        })
    }
}

/// The JSON Schema of a scenario file. Structs are objects, and lists and tuples are arrays. A distribution
/// may stand in place of any number, as `{"Uniform": [2, 5]}`. A scenario over a base gives only the fields
/// that differ.
#[must_use]
pub fn scenario_schema() -> Value {
    let mut generator = SchemaSettings::draft2020_12().into_generator();
    generator.subschema_for::<Distribution>();
    let mut schema = Value::from(generator.into_root_schema_for::<ScenarioFile>());
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
    all.insert("anyOf".to_owned(), json!([{"required": ["base"]}, {"required": required}]));
    if let Some(types) = all.get_mut("$defs").and_then(Value::as_object_mut) {
        for name in ["Normal", "Rates"] {
            types.get_mut(name).and_then(Value::as_object_mut).and_then(|own| own.remove("required"));
        }
        for (name, own) in types.iter_mut() {
            if name != "Distribution" && name != "Amount" {
                let_numbers_be_drawn(own);
            }
        }
    }
    all.get_mut("properties").into_iter().for_each(let_numbers_be_drawn);
    schema
}

/// Allows a distribution in place of each number.
fn let_numbers_be_drawn(schema: &mut Value) {
    match schema {
        Value::Object(fields) => {
            let is_number = matches!(fields.get("type").and_then(Value::as_str), Some("number" | "integer"));
            if is_number && !fields.contains_key("anyOf") {
                let mut number = serde_json::Map::new();
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
