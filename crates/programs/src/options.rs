//! The options of a program.

use std::time::Duration;

use ron_tree::{Node, Value as Ron};
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::{Map, Value};

/// Longest time that may be given to a program, in seconds.
const MOST_S: f64 = 86_400.0;

/// How a program is started, and how long it may take.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Options {
    /// The program and its arguments.
    pub(crate) command: Vec<String>,
    /// What the program is told in the hello.
    pub(crate) options: Json,
    /// Longest time of an answer, in seconds.
    pub(crate) timeout_s: f64,
    /// Longest time until the hello, in seconds.
    pub(crate) start_s: f64,
    /// Files that decide answers, besides those that the command names: patterns such as `*.py`.
    pub(crate) sources: Vec<String>,
}

/// Options that cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum OptionsError {
    #[error("command: must have at least one word, as in [\"python3\", \"my.py\"]")]
    NoCommand,
    #[error("{field}: must be above 0 and at most {MOST_S}")]
    Time { field: &'static str },
    #[error("sources: {pattern:?} is no pattern of files: {reason}")]
    Pattern { pattern: String, reason: &'static str },
}

impl Default for Options {
    fn default() -> Self {
        Self {
            command: Vec::new(),
            options: Json::default(),
            timeout_s: 10.0,
            start_s: 60.0,
            sources: Vec::new(),
        }
    }
}

impl Options {
    /// Checks what can be checked without starting anything.
    pub(crate) fn check(&self) -> Result<(), OptionsError> {
        if self.command.first().is_none_or(String::is_empty) {
            return Err(OptionsError::NoCommand);
        }
        for (field, seconds) in [("timeout_s", self.timeout_s), ("start_s", self.start_s)] {
            if !(seconds > 0.0 && seconds <= MOST_S) {
                return Err(OptionsError::Time { field });
            }
        }
        for pattern in &self.sources {
            glob::Pattern::new(pattern)
                .map_err(|error| OptionsError::Pattern { pattern: pattern.clone(), reason: error.msg })?;
        }
        Ok(())
    }

    /// Longest time of an answer.
    pub(crate) fn timeout(&self) -> Duration {
        Duration::from_secs_f64(self.timeout_s)
    }

    /// Longest time until the hello.
    pub(crate) fn start(&self) -> Duration {
        Duration::from_secs_f64(self.start_s)
    }
}

/// A value in RON as JSON. Structs and maps are objects, lists and tuples are arrays, `None` and `()` are
/// null, any other name is a text, and `Name(..)` is an object with one field.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(transparent)]
pub(crate) struct Json(pub(crate) Value);

impl Default for Json {
    fn default() -> Self {
        Self(Value::Object(Map::new()))
    }
}

impl<'de> Deserialize<'de> for Json {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Node::deserialize(deserializer).map(|node| Self(json(&node)))
    }
}

fn json(node: &Node) -> Value {
    let all = |entries: &[Node]| Value::Array(entries.iter().map(json).collect());
    match &node.value {
        Ron::Word(word) => of_word(node, word),
        Ron::Text(text) => Value::String(text.to_string()),
        Ron::List(entries) => all(entries),
        Ron::Tuple(name, entries) => match (&**name, &entries[..]) {
            ("", []) => Value::Null,
            ("", entries) => all(entries),
            ("Some", [entry]) => json(entry),
            (name, [entry]) => named(name, json(entry)),
            (name, entries) => named(name, all(entries)),
        },
        Ron::Struct(name, fields) if name.is_empty() => object(fields),
        Ron::Struct(name, fields) => named(name, object(fields)),
        Ron::Map(fields) => object(fields),
    }
}

fn object(fields: &[(Node, Node)]) -> Value {
    let key = |key: &Node| key.as_text().map_or_else(|| key.to_string(), str::to_owned);
    Value::Object(fields.iter().map(|(name, value)| (key(name), json(value))).collect())
}

fn named(name: &str, value: Value) -> Value {
    Value::Object(Map::from_iter([(name.to_owned(), value)]))
}

fn of_word(node: &Node, word: &str) -> Value {
    match word {
        "true" => Value::Bool(true),
        "false" => Value::Bool(false),
        "None" => Value::Null,
        _ => {
            let whole =
                node.read_as::<i64>().map(Value::from).or_else(|_| node.read_as::<u64>().map(Value::from));
            let number = whole.or_else(|_| node.read_as::<f64>().map(Value::from));
            // JSON has no number for infinity: it is a text, as any other word is.
            let number = number.ok().filter(|number| !number.is_null());
            number.unwrap_or_else(|| Value::String(word.to_owned()))
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn read(text: &str) -> Value {
        Node::parse(text).unwrap().read_as::<Json>().unwrap().0
    }

    #[test]
    fn any_value_in_ron_is_a_value_in_json() {
        let text = "(a: 1, b: [2.5, -3], c: {\"x y\": true}, e: Sum, f: None, g: Some(4), h: (1, \"two\"), \
                    i: Uniform(1, 2), j: Named(k: 1))";
        let expected = json!({
            "a": 1, "b": [2.5, -3], "c": {"x y": true}, "e": "Sum", "f": null, "g": 4, "h": [1, "two"],
            "i": {"Uniform": [1, 2]}, "j": {"Named": {"k": 1}},
        });
        assert_eq!(read(text), expected);
        assert_eq!(read("18446744073709551615"), json!(u64::MAX));
        let again = Node::of(&Json(read("(a: [1, ()], b: {\"c\": -0.5})"))).unwrap().to_string();
        assert_eq!(read(&again), json!({"a": [1, null], "b": {"c": -0.5}}));
    }
}
