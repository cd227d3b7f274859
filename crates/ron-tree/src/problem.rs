//! What is wrong with a value, in words of the file.

use std::fmt;
use std::path::PathBuf;

use crate::nearest;

/// The rule that a field breaks which does not exist.
pub const NO_FIELD: &str = "is no field";

/// The rule that a field breaks which is left out and has no default.
pub const MUST_BE_GIVEN: &str = "must be given";

/// Most characters of a value that a message quotes.
const MOST_SHOWN: usize = 60;

/// A value that breaks a rule.
#[derive(Debug, Clone, PartialEq, Eq, Default, thiserror::Error)]
pub struct Problem {
    /// Path of the field, such as `tasks.village.grid[0]`; empty for the whole text.
    pub field: String,
    /// The file of the field, if it is not the file that was read but its base.
    pub file: Option<PathBuf>,
    /// Line of the field in its file, where it is known.
    pub line: Option<usize>,
    /// The rule for the value, as the rest of a sentence: `must be a whole number`.
    pub rule: String,
    /// The value as it is; empty if there is none.
    pub found: String,
    /// A hint at what may have been meant, or at what to do; empty without one.
    pub hint: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { field, rule, found, hint, .. } = self;
        let field = if field.is_empty() { "the file" } else { field };
        let found = if found.is_empty() { String::new() } else { format!(", found {found}") };
        let hint = if hint.is_empty() { String::new() } else { format!("; {hint}") };
        write!(f, "{field} {rule}{found}{hint}")
    }
}

impl Problem {
    /// A broken rule, with the value as it is.
    pub fn new(field: impl Into<String>, rule: impl Into<String>, found: impl fmt::Display) -> Self {
        let (field, rule, found) = (field.into(), rule.into(), shown(&found.to_string()));
        Self { field, rule, found, ..Self::default() }
    }

    /// The same, with a hint.
    pub(crate) fn with_hint(self, hint: impl Into<String>) -> Self {
        Self { hint: hint.into(), ..self }
    }

    /// The same, of a field within this segment of a path: `name` or `[0]`.
    pub(crate) fn within(mut self: Box<Self>, segment: &str) -> Box<Self> {
        let joint = if self.field.is_empty() || self.field.starts_with('[') { "" } else { "." };
        self.field = format!("{segment}{joint}{}", self.field);
        self
    }
}

/// A value as a message quotes it: on one line, and shortened.
fn shown(value: &str) -> String {
    let line = value.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.chars().count() <= MOST_SHOWN {
        line
    } else {
        line.chars().take(MOST_SHOWN).chain("...".chars()).collect()
    }
}

/// A hint with the name that was probably meant, and the known names.
fn meant(name: &str, known: &[&str]) -> String {
    let there =
        if known.is_empty() { "here are none".to_owned() } else { format!("here are {}", known.join(", ")) };
    match nearest(name, known.iter().copied()) {
        Some(meant) => format!("did you mean {meant}? T{there}"),
        None => format!("t{there}"),
    }
}

impl serde::de::Error for Box<Problem> {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self::new(Problem { rule: message.to_string(), ..Problem::default() })
    }

    fn invalid_type(_: serde::de::Unexpected, expected: &dyn serde::de::Expected) -> Self {
        Self::custom(format!("must be {expected}"))
    }

    fn invalid_value(_: serde::de::Unexpected, expected: &dyn serde::de::Expected) -> Self {
        Self::custom(format!("must be {expected}"))
    }

    fn invalid_length(_: usize, expected: &dyn serde::de::Expected) -> Self {
        Self::custom(format!("must be {expected}"))
    }

    fn unknown_variant(name: &str, expected: &'static [&'static str]) -> Self {
        let hint = nearest(name, expected.iter().copied());
        let hint = hint.map_or(String::new(), |meant| format!("did you mean {meant}?"));
        Self::new(Problem::new("", format!("must be one of {}", expected.join(", ")), name).with_hint(hint))
    }

    fn unknown_field(name: &str, expected: &'static [&'static str]) -> Self {
        Self::new(Problem::new(name, NO_FIELD, "").with_hint(meant(name, expected)))
    }

    fn missing_field(name: &'static str) -> Self {
        Self::new(Problem::new(name, MUST_BE_GIVEN, ""))
    }

    fn duplicate_field(name: &'static str) -> Self {
        Self::new(Problem::new(name, "must not be given twice", ""))
    }
}
