//! Setting one field of a scenario by its path.

use thiserror::Error;

use super::{Fields, ScenarioFile, ron_options};

/// A field that cannot be set.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SetError {
    /// There is no such field.
    #[error("{path}: no such field; {within} has {known}")]
    Unknown {
        /// The path that was asked for.
        path: String,
        /// What is there of it, in words.
        within: String,
        /// The fields there.
        known: String,
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

impl ScenarioFile {
    /// Sets the field at a path such as `costs.energy.per_step` or `tasks.hard.grid[0]` to a value in RON. Rules are not checked: that
    /// is done when the file becomes a scenario.
    ///
    /// # Errors
    /// There is no such field, or the value is not of its type.
    pub fn set(&mut self, path: &str, value: &str) -> Result<(), SetError> {
        let malformed = |reason: String| SetError::Malformed {
            path: path.to_owned(),
            reason,
            found: value.trim().to_owned(),
        };
        let text = ron::to_string(self).map_err(|error| malformed(error.to_string()))?;
        let fields = Fields::of(&text);
        let place = fields.value(path).ok_or_else(|| fields.unknown(path))?;
        if !is_one_value(value) {
            return Err(malformed("must be one value in RON".into()));
        }
        let text = [&text[..place.start], value, &text[place.end..]].concat();
        *self = ron_options().from_str(&text).map_err(|error| malformed(error.code.to_string()))?;
        Ok(())
    }
}

/// Whether a text is one value: whatever closes a bracket or opens a comment would change more than one field.
fn is_one_value(text: &str) -> bool {
    let wrapped = format!("[{text}]");
    let value = Fields::of(&wrapped).value("[0]");
    value.is_some_and(|value| wrapped[value].trim() == text.trim())
}

impl Fields {
    /// What is to be said of a path that is none of these fields.
    #[must_use]
    pub fn unknown(&self, path: &str) -> SetError {
        let mut within = path;
        let known = loop {
            within = within.rfind(['.', '[']).map_or("", |end| &within[..end]);
            if let Some(count) = self.entries(within).filter(|_| path[within.len()..].starts_with('[')) {
                break format!("{count} entries, from [0] on");
            }
            let known = self.inside(within);
            if !known.is_empty() || within.is_empty() {
                break known.join(", ");
            }
        };
        let within = if within.is_empty() { "a scenario".to_owned() } else { within.to_owned() };
        SetError::Unknown { path: path.to_owned(), within, known }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::DebrisShape;

    fn file() -> ScenarioFile {
        let row = "(role: Carrier, count: 2, center: (5, 5), width_m: 2)";
        let debris = "(shape: Box(1, 2), at: (8, 8)), (shape: Disc(0.5), at: (3, 3))";
        let text = format!(
            "(name: \"t\", duration_s: 60, dt_s: 0.02, arena_m: (20, 20), team: [{row}], debris: [{debris}])"
        );
        ron_options().from_str(&text).unwrap()
    }

    #[test]
    fn one_field_is_set_and_no_other() {
        let mut set = file();
        set.set("costs.energy.per_step", "0.009").unwrap();
        set.set("rne.hard_rule", "MeanEnergy").unwrap();
        set.set("debris[0].shape", "Box(3, 1)").unwrap();
        set.set("team[0].levels", "(energy: 50, hp: 60)").unwrap();
        set.set("arena_m[1]", "30").unwrap();
        let mut expected = file();
        expected.costs.energy.per_step = 0.009;
        expected.rne.hard_rule = rne_core::grouping::rne::HardRule::MeanEnergy;
        expected.debris[0].shape = DebrisShape::Box(3.0, 1.0);
        expected.team[0].levels = Some(crate::scenario::Levels { energy: 50.0, hp: 60.0 });
        expected.arena_m[1] = 30.0;
        assert_eq!(set, expected);
    }

    #[test]
    fn what_cannot_be_set_is_named_and_nothing_changes() {
        let refused = |path: &str, value: &str| {
            let mut set = file();
            let error = set.set(path, value).unwrap_err().to_string();
            assert_eq!(set, file(), "{path}");
            error
        };
        assert_eq!(
            refused("costs.energy.per_stop", "1"),
            "costs.energy.per_stop: no such field; costs.energy has per_step, per_metre, per_second"
        );
        assert!(refused("cots.energy", "1").contains("a scenario has name, description, sweep"));
        assert_eq!(
            refused("debris[7].at", "(1, 1)"),
            "debris[7].at: no such field; debris has 2 entries, from [0] on"
        );
        assert!(refused("duration_s", "\"long\"").contains("found \"long\""));
        assert!(refused("rne.hard_rule", "Luck").contains("IntraGroupTrust"));
        for value in ["1, dt_s: 1", "1) //", "1 /* ", "", "(1"] {
            assert!(refused("duration_s", value).starts_with("duration_s: "), "{value}");
        }
    }
}
