//! The common part of all rules of a scenario: they note problems.

use std::fmt::Display;

use ron_tree::limits::Limit;
use ron_tree::nearest;

use super::error::Problem;
use super::file::{Amount, Point};
use crate::limits;

/// Most problems that are reported at once. A reader mends the first of them first.
const MAX_PROBLEMS: usize = 100;

pub(super) struct Checker {
    pub(super) problems: Vec<Problem>,
    pub(super) arena: Point,
}

impl Checker {
    /// Notes a broken rule, unless there are [`MAX_PROBLEMS`] already.
    pub(super) fn fail(&mut self, field: impl Into<String>, rule: impl Into<String>, found: impl Display) {
        self.fail_with(field, rule, String::new(), found);
    }

    /// Notes a broken rule with a hint.
    pub(super) fn fail_with(
        &mut self,
        field: impl Into<String>,
        rule: impl Into<String>,
        hint: String,
        found: impl Display,
    ) {
        if self.problems.len() >= MAX_PROBLEMS {
            return;
        }
        let (field, rule, found) = (field.into(), rule.into(), found.to_string());
        self.problems.push(Problem { field, rule, found, hint, ..Problem::default() });
    }

    /// Whether the list of problems is full.
    pub(super) fn is_full(&self) -> bool {
        self.problems.len() >= MAX_PROBLEMS
    }

    pub(super) fn number(&mut self, field: impl Into<String>, value: f64, limit: Limit) {
        if !limit.range().contains(&value) {
            let rule = format!("must be a number from {} to {}", limit.least, limit.most);
            let other_unit = [value / 1000.0, value * 1000.0].into_iter().find(|other| {
                (value > 4.0 * limit.most || value > 0.0 && value < limit.least / 4.0)
                    && limit.range().contains(other)
            });
            let hint = other_unit
                .map_or(String::new(), |other| format!("is the unit right? {other} would be in range"));
            let found = if value.abs() < 1e15 { value.to_string() } else { format!("{value:e}") };
            self.fail_with(field, rule, hint, found);
        }
    }

    /// Checks that a number in its range is at least another one.
    pub(super) fn at_least(&mut self, field: &str, value: f64, least: f64, limit: Limit) {
        if limit.range().contains(&value) && limit.range().contains(&least) {
            self.number(field, value, Limit { least, ..limit });
        }
    }

    /// Checks the ends of a distribution. A plain number is in its range already.
    pub(super) fn amount(&mut self, field: &str, amount: &Amount, limit: Limit) {
        if matches!(amount, Amount::Drawn(_)) {
            amount.support().into_iter().for_each(|end| self.number(field, end, limit));
        }
    }

    /// Checks the number of entries of a table or list.
    pub(super) fn entries(&mut self, field: impl Into<String>, count: usize, limit: Limit) {
        if !limit.allows(count) {
            let rule = match limit.least {
                0.0 => format!("must have at most {} entries", limit.most),
                least => format!("must have {least} to {} entries", limit.most),
            };
            self.fail(field, rule, count);
        }
    }

    /// Checks that a point is at least `margin` metres inside the arena.
    pub(super) fn inside(&mut self, field: impl Into<String>, point: Point, margin: f64) {
        let fits = |x: f64, size: f64| x >= margin && x <= size - margin;
        if !fits(point[0], self.arena[0]) || !fits(point[1], self.arena[1]) {
            let rule = format!("must lie in the arena, at least {margin} m from its walls");
            self.fail(field, rule, format!("({}, {})", point[0], point[1]));
        }
    }
}

/// A hint with the most similar known name; empty if there is none.
pub(super) fn meant<'k>(name: &str, known: impl IntoIterator<Item = &'k str>) -> String {
    nearest(name, known).map_or(String::new(), |meant| format!("did you mean {meant}?"))
}

/// A name for messages: in quotes, and no longer than a line.
pub(super) fn shown(name: &str) -> String {
    let start: String = name.chars().take(80).collect();
    if start.len() < name.len() {
        format!("{start:?}... of {} bytes", name.len())
    } else {
        format!("{name:?}")
    }
}

/// Whether Windows has a device of this name, with or without an extension. No file can have such a name.
pub(super) fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().to_ascii_lowercase();
    let numbered =
        |kind| stem.strip_prefix(kind).is_some_and(|rest| matches!(rest.as_bytes(), [b'1'..=b'9']));
    ["con", "prn", "aux", "nul"].contains(&stem.as_str()) || numbered("com") || numbered("lpt")
}

/// The rule that [`is_mistaken`] names break.
pub const NOT_MISTAKEN: &str = "must not be what readers of tables take for a number, or for nothing";

/// Whether programs that read tables take this text for a number, for a truth value, or for a missing value.
///
/// ```
/// use scenario::is_mistaken;
///
/// assert!(["NA", "None", "nan", "null", "1e5", "true"].into_iter().all(is_mistaken));
/// assert!(!is_mistaken("north") && !is_mistaken("a1e5"));
/// ```
pub fn is_mistaken(name: &str) -> bool {
    let words = ["na", "none", "null", "nil", "true", "false"];
    words.contains(&name.to_ascii_lowercase().as_str()) || name.parse::<f64>().is_ok()
}

/// Checks that each name of a table is plain and occurs once.
pub(super) fn names<'n>(check: &mut Checker, table: &str, names: impl Iterator<Item = &'n str>) {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
    let mut seen: Vec<&str> = Vec::new();
    for (i, name) in names.enumerate() {
        let field = format!("{table}[{i}].name");
        if !limits::NAME_BYTES.allows(name.len()) || name.starts_with('-') || !name.chars().all(plain) {
            let rule =
                "must be a name of at most 64 letters, digits, `-` and `_` that does not start with `-`";
            check.fail(field, rule, shown(name));
        } else if is_mistaken(name) {
            check.fail(field, NOT_MISTAKEN, shown(name));
        } else if is_device(name) {
            check.fail(field, "must not be the name of a device on Windows", shown(name));
        } else if seen.contains(&name) {
            check.fail(field, "must not be listed twice", shown(name));
        }
        seen.push(name);
    }
}

/// Path of an entry of a table, by the name of the entry.
pub(super) fn entry(table: &str, name: &str) -> String {
    format!("{table}.{name}")
}
