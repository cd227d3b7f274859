//! The options of a program.

use std::ffi::OsStr;
use std::path::{Component, Path};
use std::time::Duration;

use ron_tree::{Node, Value as Ron};
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::{Map, Value};

/// The policy's name.
pub(crate) const NAME: &str = "EXEC";

/// The variables of the environment that each program gets, besides those that begin with `USAR_`.
const USUAL: [&str; 4] = ["PATH", "HOME", "LANG", "TMPDIR"];

/// Longest time that may be given to a program, in seconds.
const MOST_S: f64 = 86_400.0;

teaming::options! {
    /// How a program is started, and how long it may take.
    pub(crate) struct Options {
        /// The program and its arguments.
        pub(crate) command: Vec<String> = Vec::new(),
        /// What the program is told in the hello.
        pub(crate) options: Json = Json::default(),
        /// Longest time of an answer, in seconds.
        pub(crate) timeout_s: f64 = 10.0,
        /// Longest time until the hello, in seconds.
        pub(crate) start_s: f64 = 60.0,
        /// Files that decide answers, besides those that the command names: patterns such as `*.py`.
        pub(crate) sources: Vec<String> = Vec::new(),
        /// Names of variables of the environment that the program gets, besides the usual ones.
        pub(crate) env: Vec<String> = Vec::new(),
        /// Whether each robot has a process of its own, behind `by`.
        pub(crate) isolate: bool = false,
    }
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
    #[error("isolate: must be false for a policy; only behind `by` are there robots to keep apart")]
    Isolate,
    #[error("env: must be names of variables, found {0:?}")]
    Variable(String),
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
            if let Some(reason) = broken_rule(pattern) {
                return Err(OptionsError::Pattern { pattern: pattern.clone(), reason });
            }
        }
        let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let is_name = |name: &&String| !name.is_empty() && name.chars().all(is_part);
        match self.env.iter().find(|name| !is_name(name)) {
            Some(name) => Err(OptionsError::Variable(name.clone())),
            None => Ok(()),
        }
    }

    /// Whether the program gets a variable of the environment.
    pub(crate) fn passes(&self, name: &OsStr) -> bool {
        let Some(name) = name.to_str() else { return false };
        USUAL.contains(&name) || name.starts_with("USAR_") || self.env.iter().any(|own| own == name)
    }

    /// The command as one visible line of a shell, and the variables that it asks for.
    pub(crate) fn in_words(&self) -> String {
        let words: Vec<String> = self.command.iter().map(|word| quoted(word)).collect();
        let env = match &self.env[..] {
            [] => String::new(),
            names => format!(" (and it asks for {} of the environment)", names.join(", ")),
        };
        ron_tree::visible(&(words.join(" ") + &env)).replace('\n', "\\n")
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

/// Why a pattern names no files in the working folder, if it does not.
fn broken_rule(pattern: &str) -> Option<&'static str> {
    let is_inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    if pattern.is_empty() || !Path::new(pattern).components().all(is_inside) {
        return Some("it must be of files in the folder in which the program starts");
    }
    glob::Pattern::new(pattern).err().map(|error| error.msg)
}

/// A word as a shell takes it.
#[must_use]
pub fn quoted(text: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./,:=+%".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) {
        return text.to_owned();
    }
    format!("'{}'", text.replace('\'', "'\\''"))
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

    #[test]
    fn a_word_is_quoted_for_a_shell_where_it_must_be() {
        assert_eq!([quoted("a/b.ron"), quoted("it's")], ["a/b.ron", "'it'\\''s'"]);
    }
}
