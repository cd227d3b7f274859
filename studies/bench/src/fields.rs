//! The fields of a text that is being read, and what is wrong with them.

use std::fmt;

use serde_json::Value;

/// The largest number in size: sums and squares of such numbers are finite.
const MOST: f64 = 1e100;

/// What is wrong with a field.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BadField {
    /// The field, such as `R[3]`.
    pub field: String,
    /// The rule that it breaks.
    pub rule: String,
    /// What was found.
    pub found: String,
}

impl fmt::Display for BadField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: must {}, found {}", self.field, self.rule, self.found)
    }
}

/// Why a text is no problem.
#[derive(Debug, thiserror::Error)]
pub enum BadProblem {
    /// It is not JSON.
    #[error("the text is not JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// Fields, all at once.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Fields(Vec<BadField>),
}

/// A text that is being read, with what is wrong so far.
pub(crate) struct Reader<'j> {
    pub(crate) json: &'j Value,
    pub(crate) bad: Vec<BadField>,
}

impl Reader<'_> {
    pub(crate) fn refuse(
        &mut self,
        field: impl fmt::Display,
        rule: impl fmt::Display,
        found: impl fmt::Display,
    ) {
        let [field, rule, found] = [field.to_string(), rule.to_string(), found.to_string()];
        self.bad.push(BadField { field, rule, found });
    }

    /// A finite number of at most [`MOST`] in size; 0 if it is none, which is refused.
    pub(crate) fn number(&mut self, field: impl fmt::Display, value: Option<&Value>) -> f64 {
        let number = value.and_then(Value::as_f64).filter(|number| number.is_finite());
        match number {
            None => self.refuse(field, "be a finite number", found(value)),
            Some(number) if number.abs() > MOST => {
                self.refuse(field, format!("be at most {MOST:e} in size"), found(value));
            }
            Some(number) => return number,
        }
        0.0
    }
}

pub(crate) fn found(value: Option<&Value>) -> String {
    value.map_or("nothing".to_owned(), ToString::to_string)
}
