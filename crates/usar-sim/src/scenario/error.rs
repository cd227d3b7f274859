//! Errors of scenarios: file, line, field, rule and found value, all problems of a file at once.

use std::fmt;
use std::path::PathBuf;

use thiserror::Error;

/// One value that breaks a rule.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Problem {
    /// Path of the field, e.g. `tasks.village.grid[0]`.
    pub field: String,
    /// The file that the field stands in, where it is another than the one that was read: its base.
    pub file: Option<PathBuf>,
    /// Line of the field in its file, where it is known.
    pub line: Option<usize>,
    /// What holds for the field, e.g. `must be a number from 0 to 100`.
    pub rule: String,
    /// What stands there; empty where nothing does.
    pub found: String,
    /// What may have been meant, or what to do; empty without an idea.
    pub hint: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { field, rule, found, hint, .. } = self;
        let found = if found.is_empty() { String::new() } else { format!(", found {found}") };
        let hint = if hint.is_empty() { String::new() } else { format!("; {hint}") };
        write!(f, "{field} {rule}{found}{hint}")
    }
}

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
    #[error("{}:{line}:{column}: {message}{}{excerpt}", path.display(), if excerpt.is_empty() { "" } else { "\n" })]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong.
        message: String,
        /// The line with a caret below the column; may be empty.
        excerpt: String,
    },
    /// A file in the former format.
    #[error("{}:{line}: {change}", path.display())]
    Former {
        /// The file.
        path: PathBuf,
        /// Line of the field, from 1.
        line: usize,
        /// The field, and what to write instead.
        change: String,
    },
    /// Values break rules.
    #[error("{0}")]
    Invalid(Problems),
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
        "debris leaves no way from home to {to} that is wide enough for a robot of radius {radius_m} m with \
         clearance"
    )]
    NoPassage {
        /// Where to.
        to: String,
        /// Radius of the robot, in metres.
        radius_m: f64,
    },
}
