//! Setting one field of a value by its path.

use std::ops::Range;

use ron::extensions::Extensions;
use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

use crate::path::is_segment;
use crate::told::NO_FIELD;
use crate::{Fields, Misfit, nearest};

/// Why a field cannot be set.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum SetError {
    /// There is no such field.
    #[error("{path}: no such field; {within} has {known}{}", asked(meant.as_deref()))]
    Unknown {
        /// The requested path.
        path: String,
        /// The existing part of the path, in words.
        within: String,
        /// The fields of that part.
        known: String,
        /// The field that may have been meant.
        meant: Option<String>,
    },
    /// The value does not fit the field.
    #[error("{path}: {reason}, found {found}")]
    Malformed {
        /// The path.
        path: String,
        /// Why it does not fit.
        reason: String,
        /// The value as given.
        found: String,
    },
}

fn asked(meant: Option<&str>) -> String {
    meant.map_or(String::new(), |meant| format!("; did you mean {meant}?"))
}

/// Sets the field at a path such as `costs.energy` or `tasks.hard.grid[0]` to `new`, in RON, and returns
/// the changed value. `what` describes the whole value in messages, for example `a scenario`. The value's
/// types refuse unknown fields (`deny_unknown_fields`).
///
/// # Errors
/// The field does not exist, or the new value does not have its type.
pub fn set<T: Serialize + DeserializeOwned>(
    value: &T,
    path: &str,
    new: &str,
    what: &str,
) -> Result<T, SetError> {
    let found = || new.trim().to_owned();
    let malformed = |reason: String| SetError::Malformed { path: path.to_owned(), reason, found: found() };
    let text = ron::to_string(value).map_err(|error| malformed(error.to_string()))?;
    let fields = Fields::of(&text);
    let (place, written) = match fields.value(path) {
        Some(place) => (place, new.to_owned()),
        None => omitted(&fields, path, new).ok_or_else(|| fields.unknown(path, what))?,
    };
    if !is_one_value(new) {
        return Err(malformed("must be one value in RON".into()));
    }
    let text = [&text[..place.start], &written, &text[place.end..]].concat();
    options().from_str(&text).map_err(|error| {
        let Misfit { field, rule, hint, .. } =
            Misfit::new(&error.code, path, (&text, place.start), &Fields::of(&text));
        if rule == NO_FIELD && place.is_empty() {
            return no_such_field(path, &hint);
        }
        let inner = field.strip_prefix(path).map_or("", |rest| rest.trim_start_matches('.'));
        let inner = if inner.is_empty() { String::new() } else { format!("{inner} ") };
        let hint = if hint.is_empty() { hint } else { format!(" ({hint})") };
        malformed(format!("{inner}{rule}{hint}"))
    })
}

/// Where to write a field that serde omits as long as it has its default, and what to write there: `None` if
/// nothing of what is around it is written.
fn omitted(fields: &Fields, path: &str, new: &str) -> Option<(Range<usize>, String)> {
    let (around, name) = path.rsplit_once('.')?;
    let first = *fields.inside(around).first().filter(|first| !first.starts_with('['))?;
    let before = fields.value(&format!("{around}.{first}"))?.start.checked_sub(first.len() + ":".len())?;
    is_segment(name).then(|| (before..before, format!("{name}:{new},")))
}

/// The error for a field that was written where serde may omit one. The misfit's hint ends with the known
/// names.
fn no_such_field(path: &str, hint: &str) -> SetError {
    let (within, name) = path.rsplit_once('.').unwrap_or_default();
    let known = hint.rsplit("here are ").next().unwrap_or_default();
    let meant = nearest(name, known.split(", ")).map(str::to_owned);
    SetError::Unknown { path: path.to_owned(), within: within.to_owned(), known: known.to_owned(), meant }
}

fn options() -> ron::Options {
    ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME)
}

/// Whether a text is exactly one value. A text that closes a bracket or opens a comment would change more
/// than one field.
pub(crate) fn is_one_value(text: &str) -> bool {
    let wrapped = format!("[{text}]");
    let value = Fields::of(&wrapped).value("[0]");
    value.is_some_and(|value| wrapped[value].trim() == text.trim())
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::*;

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Mission {
        duration_s: f64,
        arena_m: [f64; 2],
        order: Order,
        levels: Option<Levels>,
        tasks: Vec<Task>,
    }

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Levels {
        energy: f64,
    }

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    enum Order {
        Near,
        Ring(f64, f64),
    }

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Task {
        name: String,
        grid: [u32; 2],
        steps: Vec<Step>,
    }

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Step {
        name: String,
        cost: f64,
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        is_last: bool,
    }

    fn mission() -> Mission {
        let step = |name: &str, cost| Step { name: name.to_owned(), cost, is_last: false };
        let task = |name: &str, grid| Task {
            name: name.to_owned(),
            grid,
            steps: vec![step("go", 1.0), step("lift", 2.0)],
        };
        Mission {
            duration_s: 60.0,
            arena_m: [20.0, 20.0],
            order: Order::Near,
            levels: None,
            tasks: vec![task("hard", [3, 4]), task("easy", [1, 1]), task("hard", [7, 8])],
        }
    }

    #[test]
    fn one_field_is_set_and_no_other() {
        let mut found = mission();
        for (path, new) in [
            ("duration_s", " 90 "),
            ("arena_m[1]", "30"),
            ("order", "Ring(3, 1)"),
            ("levels", "(energy: 50)"),
            ("levels.energy", "55"),
            ("tasks[1].grid[1]", "2"),
            ("tasks.hard.grid[0]", "9"),
            ("tasks.easy.steps.lift.cost", "0.5"),
            ("tasks.easy.steps.lift.is_last", "true"),
        ] {
            found = set(&found, path, new, "a mission").unwrap();
        }
        let mut expected = mission();
        expected.duration_s = 90.0;
        expected.arena_m[1] = 30.0;
        expected.order = Order::Ring(3.0, 1.0);
        expected.levels = Some(Levels { energy: 55.0 });
        expected.tasks[1].grid[1] = 2;
        expected.tasks[0].grid[0] = 9;
        expected.tasks[1].steps[1].cost = 0.5;
        expected.tasks[1].steps[1].is_last = true;
        assert_eq!(found, expected);
    }

    #[test]
    fn an_entry_can_be_named_anew() {
        let mission = set(&mission(), "tasks.easy.name", "\"light\"", "a mission").unwrap();
        assert_eq!(mission.tasks[1].name, "light");
        assert!(set(&mission, "tasks.easy.name", "\"easy\"", "a mission").is_err());
    }

    #[test]
    fn what_cannot_be_set_is_named() {
        let refused =
            |path: &str, new: &str| set(&mission(), path, new, "a mission").unwrap_err().to_string();
        for (path, says) in [
            ("duration", "a mission has duration_s, arena_m, order, levels, tasks"),
            ("arena_m[2]", "arena_m has 2 entries, from [0] on"),
            ("tasks.medium", "tasks has hard, easy (or [0] to [2])"),
            ("tasks.hard.steps.go.price", "tasks.hard.steps.go has name, cost, is_last"),
            ("tasks.hard.steps.fly.cost", "tasks.hard.steps has go, lift (or [0] to [1])"),
        ] {
            let error = refused(path, "1");
            assert!(error.starts_with(&format!("{path}: no such field; {says}")), "{error}");
        }
        assert!(refused("duration_s", "\"long\"").ends_with(", found \"long\""));
        let error = refused("tasks.hard.steps.go.is_last", "3");
        assert!(error.starts_with("tasks.hard.steps.go.is_last: ") && error.ends_with("found 3"), "{error}");
        assert!(refused("order", "Far").starts_with("order: "));
        for new in ["1, dt_s: 1", "1) //", "1 /* ", "", "(1", "a: 1"] {
            let error = refused("duration_s", new);
            assert!(error.starts_with("duration_s: must be one value in RON, found"), "{new}: {error}");
        }
    }
}
