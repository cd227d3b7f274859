//! Errors of scenarios: file, line, field, rule and found value, all problems of a file at once.

use std::fmt;
use std::path::{Path, PathBuf};

use ron_tree::Malformed;
pub use ron_tree::Problem;
use thiserror::Error;

/// All problems of one file, in the order of its fields.
#[derive(Debug, Clone, PartialEq)]
pub struct Problems {
    /// The file.
    pub path: PathBuf,
    /// At least one problem.
    pub list: Vec<Problem>,
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, problem) in self.list.iter().enumerate() {
            let line = problem.line.map(|line| format!(":{line}")).unwrap_or_default();
            let separator = if i == 0 { "" } else { "\n" };
            let path = problem.file.as_ref().unwrap_or(&self.path).display();
            write!(f, "{separator}{path}{line}: {problem}")?;
        }
        Ok(())
    }
}

/// Where something stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Location {
    /// The file.
    pub file: PathBuf,
    /// The line, where it is known.
    pub line: Option<usize>,
    /// Path of the field, unless it is about the whole file.
    pub field: Option<String>,
}

/// A scenario that cannot be used.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ScenarioError {
    /// The file cannot be read.
    #[error("{}: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// The text is not well-formed, or has too much in it.
    #[error("{}:{}:{}: {}\n{}", path.display(), source.line, source.column, source.message, source.excerpt)]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Where, and what is wrong.
        source: Malformed,
    },
    /// Values break rules.
    #[error("{0}")]
    Invalid(Problems),
}

impl ScenarioError {
    /// Where the first problem is.
    pub fn place(&self) -> Location {
        let at = |file: &Path, line, field| Location { file: file.to_owned(), line, field };
        match self {
            Self::Unreadable { path, .. } => at(path, None, None),
            Self::Malformed { path, source } => at(path, Some(source.line), None),
            Self::Invalid(Problems { path, list }) => match list.first() {
                Some(Problem { file, line, field, .. }) => {
                    at(file.as_ref().unwrap_or(path), *line, Some(field.clone()))
                }
                None => at(path, None, None),
            },
        }
    }

    /// The error of a file that another one names by this path: text of a file outside the folder of the
    /// other is not shown, for it may be none of its reader's business.
    #[must_use]
    pub fn of_named(self, named: &str) -> Self {
        let leads_out = Path::new(named).is_absolute() || named.split(['/', '\\']).any(|part| part == "..");
        match self {
            Self::Malformed { path, source } if leads_out => {
                let place = format!("line {}, column {}", source.line, source.column);
                let reason =
                    format!("is not well-formed ({place}); text from outside the folder is not shown");
                Self::Unreadable { path, reason }
            }
            other => other,
        }
    }
}

/// A trial's layout that cannot be drawn.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum LayoutError {
    /// No room for one more sampled thing.
    #[error(
        "tasks.{task}.sampled: no room for {what} {number} of {count} after {tries} tries; lower the count, \
         the radius or gap_m"
    )]
    NoRoom {
        /// Name of the task.
        task: String,
        /// `debris` or `radiation`.
        what: &'static str,
        /// Which of them, from 1.
        number: u32,
        /// How many were asked for.
        count: u32,
        /// Draws made.
        tries: u32,
    },
    /// No place for one more scattered thing.
    #[error(
        "{field}: no place for {what} {number} of {count}{tried}; lower the count, the radius or the gap, or \
         enlarge `within`"
    )]
    NoPlace {
        /// Path of the field.
        field: String,
        /// `debris` or `radiation`.
        what: &'static str,
        /// Which of them, from 1.
        number: u32,
        /// How many were asked for.
        count: u32,
        /// What was tried, in words.
        tried: String,
    },
    /// The values that were drawn break a rule, each time.
    #[error("the values drawn {tries} times never went together: {problem}")]
    NeverFits {
        /// Times that they were drawn.
        tries: u32,
        /// What was wrong the last time.
        problem: String,
    },
    /// Debris and walls leave no way for a ground robot.
    #[error(
        "walls and debris leave no way from home to {to} that is wide enough for a robot of radius \
         {radius_m} m with clearance"
    )]
    NoPassage {
        /// Where to.
        to: String,
        /// Radius of the robot, in metres.
        radius_m: f64,
    },
}
