//! Protocols 1 and 2: each message is one line with a JSON object. By protocol 1, a question gets a decision;
//! by protocol 2, turns of robots get their acts. Answers may be written as R, MATLAB and Lua write
//! them: whole numbers as `5.0`, a group of one as a number, an empty group as null.

use serde::Serialize;
use serde_json::{Map, Value};
use teaming::{Act, Decision, Question, SCHEMA_VERSION, Turn};

use crate::error::Complaint;
use crate::unique::Unique;

/// Largest number up to which every whole number is a number of JSON in every language.
const MOST_WHOLE: f64 = 9_007_199_254_740_992.0;

/// What a program answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Speaks {
    /// Questions, with decisions.
    Decisions,
    /// Turns of robots, with what they do.
    Acts,
}

impl Speaks {
    /// Version of the lines between the command and a program.
    pub(crate) fn version(self) -> u64 {
        match self {
            Self::Decisions => 1,
            Self::Acts => 2,
        }
    }
}

/// What a program is told.
#[derive(Serialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub(crate) enum Message<'a> {
    Hello {
        protocol: u64,
        schema_versions: [u32; 1],
        usar: &'static str,
        policy: &'a str,
        options: &'a Value,
        process: u32,
    },
    Question {
        id: u64,
        trial: Option<Trial<'a>>,
        question: &'a Question,
    },
    Turns {
        id: u64,
        trial: Option<Trial<'a>>,
        turns: &'a [Turn],
    },
    Bye {},
}

/// The trial that asks. Its seed is not told: by it, a program could play the trial and see what is true.
#[derive(Serialize)]
pub(crate) struct Trial<'a> {
    /// Which trial of this process it is, from 1.
    pub(crate) number: u64,
    pub(crate) scenario: &'a str,
}

impl<'a> Message<'a> {
    /// The first message.
    pub(crate) fn hello(speaks: Speaks, policy: &'a str, options: &'a Value, process: u32) -> Self {
        let (usar, protocol) = (env!("CARGO_PKG_VERSION"), speaks.version());
        Self::Hello { protocol, schema_versions: [SCHEMA_VERSION], usar, policy, options, process }
    }

    /// The message as a line.
    pub(crate) fn line(&self) -> Vec<u8> {
        let mut line = serde_json::to_vec(self).unwrap_or_default(); // texts and numbers: it can be written
        line.push(b'\n');
        line
    }
}

/// What a program says of itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Greeting {
    pub(crate) name: String,
    pub(crate) version: String,
    /// Whether the same question always gets the same answer.
    pub(crate) is_deterministic: bool,
}

impl Greeting {
    /// Reads a hello.
    pub(crate) fn read(line: &[u8], speaks: Speaks) -> Result<Self, Complaint> {
        let hello = object(line)?;
        check_type(&hello, &["hello"], "\"hello\"")?;
        let is = |field: &str, expected: u64| hello.get(field).and_then(Value::as_u64) == Some(expected);
        let expected = speaks.version();
        if !is("protocol", expected) {
            return Err(Complaint::Protocol { found: found(hello.get("protocol")), expected });
        }
        if !is("schema_version", SCHEMA_VERSION.into()) {
            return Err(Complaint::Schema(found(hello.get("schema_version"))));
        }
        let is_deterministic = match hello.get("deterministic") {
            None | Some(Value::Null) => true,
            Some(Value::Bool(is)) => *is,
            other => return Err(wrong("deterministic", "true or false", other)),
        };
        let version = match hello.get("version") {
            None | Some(Value::Null) => String::new(),
            Some(Value::String(version)) => version.clone(),
            Some(Value::Number(version)) => version.to_string(),
            other => return Err(wrong("version", "a text", other)),
        };
        match hello.get("name") {
            Some(Value::String(name)) if !name.is_empty() => {
                Ok(Self { name: name.clone(), version, is_deterministic })
            }
            other => Err(wrong("name", "a text", other)),
        }
    }
}

fn wrong(field: &'static str, rule: &'static str, value: Option<&Value>) -> Complaint {
    Complaint::Hello { field, rule, found: found(value) }
}

/// Reads the answer of a type to the message of a number.
fn answer(line: &[u8], id: u64, kind: &'static str) -> Result<Map<String, Value>, Complaint> {
    let answer = object(line)?;
    let expected = if kind == "acts" { "\"acts\" or \"error\"" } else { "\"decision\" or \"error\"" };
    check_type(&answer, &[kind, "error"], expected)?;
    if answer.get("id").and_then(Value::as_u64) != Some(id) {
        return Err(Complaint::Id { found: found(answer.get("id")), expected: id });
    }
    if answer["type"] == "error" {
        let message = answer.get("message").and_then(Value::as_str);
        return Err(Complaint::GaveUp(message.unwrap_or("without a message").to_owned()));
    }
    Ok(answer)
}

/// Reads what so many robots do in their turns.
pub(crate) fn acts(line: &[u8], id: u64, turns: usize) -> Result<Vec<Act>, Complaint> {
    let wrong = |reason: String| Complaint::Answer { to: "turns", reason };
    let Some(Value::Array(mut acts)) = answer(line, id, "acts")?.remove("acts") else {
        return Err(wrong("the field acts is no list".to_owned()));
    };
    if acts.len() != turns {
        return Err(wrong(format!(
            "acts must have one entry for each of the {turns} turns, found {}",
            acts.len()
        )));
    }
    for act in &mut acts {
        // What is null is not said.
        if let Value::Object(fields) = act {
            fields.retain(|_, value| !value.is_null());
        }
        if let Some(Value::Object(groups)) = act.get_mut("joins") {
            lists_of_lists(groups);
        }
    }
    let read = |(place, act): (usize, Value)| {
        serde_json::from_value(act).map_err(|error| wrong(format!("acts[{place}]: {error}")))
    };
    acts.into_iter().enumerate().map(read).collect()
}

/// Reads the answer to a question.
pub(crate) fn decision(line: &[u8], id: u64, question: &Question) -> Result<Decision, Complaint> {
    let mut answer = answer(line, id, "decision")?;
    let wrong = |reason: &str| Complaint::Answer { to: "question", reason: reason.to_owned() };
    let Some(Value::Object(mut fields)) = answer.remove("decision") else {
        return Err(wrong("the field decision is no object"));
    };
    fields.entry("schema_version").or_insert_with(|| SCHEMA_VERSION.into());
    if let Some(Value::Object(assignment)) = fields.get_mut("assignment") {
        lists_of_lists(assignment);
    }
    let text = Value::Object(fields).to_string();
    let decision = Decision::from_json(&text).map_err(|error| {
        let reason = error.to_string(); // its place is one in `text`, which nobody sees
        let end = reason.rfind(" at line ").unwrap_or(reason.len());
        wrong(&reason[..end])
    })?;
    decision.assignment.check(question).map_err(Complaint::Assignment)?;
    Ok(decision)
}

/// Makes a list of each group that is a number or null.
fn lists_of_lists(assignment: &mut Map<String, Value>) {
    let list = |group: &mut Value| match group {
        Value::Null => *group = Value::Array(Vec::new()),
        Value::Object(fields) if fields.is_empty() => *group = Value::Array(Vec::new()),
        Value::Number(_) => *group = Value::Array(vec![group.take()]),
        _ => {}
    };
    assignment.get_mut("idle").into_iter().for_each(list);
    if let Some(Value::Array(groups)) = assignment.get_mut("groups") {
        groups.iter_mut().for_each(list);
    }
}

/// The object in a line, with whole numbers as such.
fn object(line: &[u8]) -> Result<Map<String, Value>, Complaint> {
    let text = std::str::from_utf8(line).map_err(|_| Complaint::NotUtf8)?;
    if text.trim().is_empty() {
        return Err(Complaint::EmptyLine);
    }
    if text.starts_with('\u{feff}') {
        return Err(Complaint::Marked);
    }
    let Unique(value) = serde_json::from_str(text).map_err(|error| {
        let reason = error.to_string().replace(" at line 1 column", " at byte");
        if reason.starts_with("the field ") {
            return Complaint::Twice(reason);
        }
        not_finite(text).map_or(Complaint::NotJson(reason), Complaint::NotFinite)
    })?;
    match whole(value) {
        Value::Object(fields) => Ok(fields),
        _ => Err(Complaint::NotJson("it is no object".to_owned())),
    }
}

/// The same value with each number that is whole written as a whole number.
fn whole(value: Value) -> Value {
    match value {
        Value::Number(number) => {
            let float = number.as_f64().filter(|_| number.is_f64());
            let whole = float.filter(|float| float.fract() == 0.0 && float.abs() < MOST_WHOLE);
            match whole {
                Some(float) if float < 0.0 => Value::from(float as i64),
                Some(float) => Value::from(float as u64),
                None => Value::Number(number),
            }
        }
        Value::Array(entries) => entries.into_iter().map(whole).collect(),
        Value::Object(fields) => fields.into_iter().map(|(name, value)| (name, whole(value))).collect(),
        other => other,
    }
}

/// The word for a number that is not finite, which some languages write, if there is one outside of texts.
fn not_finite(text: &str) -> Option<&'static str> {
    let (mut is_text, mut is_escaped) = (false, false);
    for (at, c) in text.char_indices() {
        match c {
            _ if is_escaped => is_escaped = false,
            '\\' => is_escaped = is_text,
            '"' => is_text = !is_text,
            _ if is_text => {}
            _ => {
                let words = ["NaN", "nan", "-Infinity", "Infinity", "-inf", "inf"];
                if let Some(word) = words.into_iter().find(|word| text[at..].starts_with(word)) {
                    return Some(word);
                }
            }
        }
    }
    None
}

fn check_type(message: &Map<String, Value>, known: &[&str], expected: &'static str) -> Result<(), Complaint> {
    let kind = message.get("type");
    let is_known = kind.and_then(Value::as_str).is_some_and(|kind| known.contains(&kind));
    if is_known { Ok(()) } else { Err(Complaint::Type { found: found(kind), expected }) }
}

/// A value as it is shown.
fn found(value: Option<&Value>) -> String {
    value.map_or_else(|| "missing".to_owned(), Value::to_string)
}
