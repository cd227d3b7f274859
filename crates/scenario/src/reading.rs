//! Reading the texts of scenario and sweep files, and the errors of texts that cannot be read.

use std::path::Path;

use ron_tree::Node;
use serde::de::DeserializeOwned;

use super::carried::{self, carried};
use super::error::{Problems, ScenarioError};

/// Gives the text of a file by its path.
pub type ReadText<'r> = dyn Fn(&Path) -> Result<String, ScenarioError> + 'r;

/// Reads the text of a scenario or sweep file.
///
/// # Errors
/// The file is missing, not a regular file, not text, empty or too large.
pub fn read_text(path: &Path) -> Result<String, ScenarioError> {
    let unreadable = |reason: String| ScenarioError::Unreadable { path: path.to_owned(), reason };
    if let Some(text) = carried(path) {
        return Ok(text.to_owned());
    }
    let text = ron_tree::file::read_text(path)
        .map_err(|error| unreadable(format!("{error}{}", carried::meant(path, &error))))?;
    if text.trim().is_empty() {
        return Err(unreadable("is empty; `usar scenario list` has complete scenarios".into()));
    }
    Ok(text)
}

/// The tree of a text; `path` is used in messages only.
///
/// # Errors
/// The first place where the text exceeds a limit or is not well-formed.
pub fn parse_tree(text: &str, path: &Path) -> Result<Node, ScenarioError> {
    Node::parse(text).map_err(|source| ScenarioError::Malformed { path: path.to_owned(), source })
}

/// A text in the layout of the project, see [`ron_tree::formatted`]; `path` is used in messages only.
///
/// # Errors
/// Those of [`parse_tree`].
pub fn formatted(text: &str, path: &Path) -> Result<String, ScenarioError> {
    ron_tree::formatted(text).map_err(|source| ScenarioError::Malformed { path: path.to_owned(), source })
}

/// Reads a value from a RON text; `path` is used in messages only.
///
/// # Errors
/// The text exceeds a limit or is not well-formed; fields are unknown, missing or doubled, or values have
/// wrong types, each with its line.
pub fn parse_ron<T: DeserializeOwned>(text: &str, path: &Path) -> Result<T, ScenarioError> {
    match parse_tree(text, path)?.read_all() {
        (Some(value), list) if list.is_empty() => Ok(value),
        (_, list) => Err(ScenarioError::Invalid(Problems { path: path.to_owned(), list })),
    }
}
