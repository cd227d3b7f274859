//! Scenarios: read from RON, checked, and then known to be usable.

mod debris;
mod defaults;
mod error;
mod file;
mod former;
mod places;
mod set;
mod validate;

use std::ops::Deref;
use std::path::Path;

use rne_core::question::hardest_first;
use rne_core::{RoleId, TaskId};
use ron::extensions::Extensions;
use ron_fields::Fields;
use serde::de::DeserializeOwned;

pub use debris::LEAST_POLYGON_WIDTH_M;
pub use error::{LayoutError, Problem, Problems, ScenarioError};
pub use file::*;
pub use validate::MAX_ARENA_M;

/// Greatest size of a scenario file, in bytes.
const MAX_FILE_BYTES: u64 = 4 << 20;

/// Most radii for which ways on the ground are planned apart: each costs a map of what is known.
pub const MAX_RADIUS_CLASSES: usize = 4;

/// A scenario whose every value was checked. Reads like the [`ScenarioFile`] that it was made from.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario(ScenarioFile);

impl Deref for Scenario {
    type Target = ScenarioFile;

    fn deref(&self) -> &ScenarioFile {
        &self.0
    }
}

impl TryFrom<ScenarioFile> for Scenario {
    type Error = Vec<Problem>;

    fn try_from(file: ScenarioFile) -> Result<Self, Vec<Problem>> {
        let problems = validate::problems(&file);
        if problems.is_empty() { Ok(Self(file)) } else { Err(problems) }
    }
}

/// How all texts of the project are read.
pub(crate) fn ron_options() -> ron::Options {
    ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME)
}

/// Reads a text file of reasonable size.
///
/// # Errors
/// A file that is missing, a folder, not text, empty or too large.
pub fn read_text(path: &Path) -> Result<String, ScenarioError> {
    let unreadable = |reason: String| ScenarioError::Unreadable { path: path.to_owned(), reason };
    let metadata = std::fs::metadata(path).map_err(|e| unreadable(format!("cannot be read: {e}")))?;
    if metadata.is_dir() {
        return Err(unreadable("is a folder, not a scenario file".into()));
    }
    if metadata.len() > MAX_FILE_BYTES {
        return Err(unreadable(format!(
            "is larger than the {} MiB that a scenario may have",
            MAX_FILE_BYTES >> 20
        )));
    }
    let text = std::fs::read_to_string(path).map_err(|e| unreadable(format!("cannot be read: {e}")))?;
    if text.trim().is_empty() {
        return Err(unreadable("is empty; see scenarios/paper.ron for a complete scenario".into()));
    }
    Ok(text)
}

/// Reads a value from a RON text; `path` is used in messages only.
///
/// # Errors
/// A syntax error, an unknown or missing field, or a wrong type, with its line and field.
pub fn parse_ron<T: DeserializeOwned>(text: &str, path: &Path) -> Result<T, ScenarioError> {
    let malformed = |error: ron::error::SpannedError, field: String| ScenarioError::Malformed {
        path: path.to_owned(),
        line: error.span.start.line,
        column: error.span.start.col,
        field: if field.is_empty() || field == "." { String::new() } else { format!("{field}: ") },
        message: error.code.to_string(),
    };
    if let Some(at) = text.find("#![") {
        return Err(ScenarioError::Malformed {
            path: path.to_owned(),
            line: 1 + text[..at].matches('\n').count(),
            column: 1,
            field: String::new(),
            message: "extensions change what a file means and are not allowed; remove `#![...]`".into(),
        });
    }
    let options = ron_options();
    let mut deserializer = ron::Deserializer::from_str_with_options(text, &options)
        .map_err(|error| malformed(error, String::new()))?;
    let value: T = serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
        let field = error.path().to_string();
        malformed(deserializer.span_error(error.into_inner()), field)
    })?;
    deserializer.end().map_err(|code| malformed(deserializer.span_error(code), String::new()))?;
    Ok(value)
}

impl Scenario {
    /// Reads and checks a file; returns the scenario and its text.
    ///
    /// # Errors
    /// A file that is missing, a folder, not text or too large; a text that is not a scenario; values that break rules.
    pub fn load(path: &Path) -> Result<(Self, String), ScenarioError> {
        let text = read_text(path)?;
        Ok((Self::parse(&text, path)?, text))
    }

    /// Checks the text of a scenario; `path` is used in messages only.
    ///
    /// # Errors
    /// A text that is not a scenario, or values that break rules.
    pub fn parse(text: &str, path: &Path) -> Result<Self, ScenarioError> {
        if let Some((line, change)) = former::change_needed(text) {
            return Err(ScenarioError::Former { path: path.to_owned(), line, change });
        }
        let file: ScenarioFile = parse_ron(text, path)?;
        Self::try_from(file).map_err(|mut list| {
            let fields = Fields::of(text);
            for problem in &mut list {
                problem.line = fields.line(&problem.field);
            }
            ScenarioError::Invalid(Problems { path: path.to_owned(), list })
        })
    }

    /// The whole scenario with every value, as text.
    ///
    /// # Panics
    /// Never: a checked scenario can be written.
    #[must_use]
    pub fn resolved(&self) -> String {
        let pretty = ron::ser::to_string_pretty(&self.0, ron::ser::PrettyConfig::new().new_line("\n"));
        pretty.expect("a checked scenario can be written") + "\n"
    }

    /// Number of simulation steps in a trial.
    #[must_use]
    pub fn steps(&self) -> u64 {
        (self.duration_s / self.dt_s).round() as u64
    }

    /// Number of robots.
    #[must_use]
    pub fn robots(&self) -> u32 {
        self.team.iter().map(|row| row.count).sum()
    }

    /// The role of a row of the team.
    #[must_use]
    pub fn role_of(&self, row: &Row) -> RoleId {
        let place = self.roles.iter().position(|role| role.name == row.role);
        RoleId(place.unwrap_or_default() as u16)
    }

    /// The tasks from the hardest to the easiest.
    #[must_use]
    pub fn hardest_first(&self) -> Vec<TaskId> {
        hardest_first(self.tasks.iter().map(|task| task.difficulty))
    }

    /// Radii for which ways on the ground are planned, rising, in metres: those of the team's ground robots. Where there are more than
    /// [`MAX_RADIUS_CLASSES`], robots share the ways of the next larger one. At least one; 0 where nobody drives.
    #[must_use]
    pub fn ground_radii_m(&self) -> Vec<f64> {
        let roles = self.team.iter().map(|row| &self.roles[self.role_of(row).index()]);
        let ground = roles.filter(|role| role.kind == RoleKind::Ground);
        let mut radii: Vec<f64> = ground.map(|role| role.radius_m).collect();
        radii.sort_by(f64::total_cmp);
        radii.dedup();
        let all = radii.len();
        if all > MAX_RADIUS_CLASSES {
            radii = (1..=MAX_RADIUS_CLASSES).map(|i| radii[i * all / MAX_RADIUS_CLASSES - 1]).collect();
        }
        if radii.is_empty() { vec![0.0] } else { radii }
    }

    /// Radius of the largest robot of the team that moves there, in metres; 0 where there is none.
    #[must_use]
    pub fn largest_radius_m(&self, kind: RoleKind) -> f64 {
        let roles = self.team.iter().map(|row| &self.roles[self.role_of(row).index()]);
        roles.filter(|role| role.kind == kind).map(|role| role.radius_m).fold(0.0, f64::max)
    }
}
