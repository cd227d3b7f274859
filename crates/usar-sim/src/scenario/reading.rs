//! Reading the texts of scenario and sweep files, and the errors of texts that cannot be read.

use std::ops::Range;
use std::path::Path;

use ron::extensions::Extensions;
use ron_fields::{Fields, Misfit, check_size, check_syntax};
use serde::de::DeserializeOwned;

use super::error::{Problem, Problems, ScenarioError};

/// Most values of wrong types that are reported at once. The text is read once more to find each.
const MOST_MISFITS: usize = 20;

/// For texts larger than this, one value of a wrong type is reported at a time, in bytes.
const LARGE_BYTES: usize = 1 << 18;

/// Most characters of a line that are shown before a caret.
const AROUND: usize = 48;

/// The options with which all texts of the project are read.
pub(crate) fn ron_options() -> ron::Options {
    ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME)
}

/// Reads the text of a scenario or sweep file.
///
/// # Errors
/// The file is missing, not a regular file, not text, empty or too large; or the text exceeds a limit on
/// nesting, values or strings, or is not well-formed.
pub fn read_text(path: &Path) -> Result<String, ScenarioError> {
    let unreadable = |reason: String| ScenarioError::Unreadable { path: path.to_owned(), reason };
    let text = ron_fields::file::read_text(path).map_err(|error| unreadable(error.to_string()))?;
    if text.trim().is_empty() {
        return Err(unreadable("is empty; see scenarios/paper.ron for a complete scenario".into()));
    }
    check_text(&text, path)?;
    Ok(text)
}

/// Refuses a text that exceeds a limit on nesting, values or strings, or that is not well-formed. `path` is
/// used in messages only.
///
/// # Errors
/// The first place where the text exceeds a limit or is not well-formed.
pub fn check_text(text: &str, path: &Path) -> Result<(), ScenarioError> {
    let malformed = |at: usize, message: String| {
        let place = Place::of(text, at);
        let (line, column, excerpt) = (place.line, place.column, place.excerpt);
        ScenarioError::Malformed { path: path.to_owned(), line, column, message, excerpt }
    };
    if let Err(found) = check_size(text) {
        let (line, column) = (found.line, found.column);
        let (message, excerpt) = (found.to_string(), String::new());
        return Err(ScenarioError::Malformed { path: path.to_owned(), line, column, message, excerpt });
    }
    check_syntax(text).map_err(|error| malformed(error.at, error.message))
}

/// A place in a text, for messages.
struct Place {
    line: usize,
    column: usize,
    /// The line, with a caret below.
    excerpt: String,
}

impl Place {
    fn of(text: &str, at: usize) -> Self {
        let before = text.get(..at).unwrap_or(text);
        let line = 1 + before.matches('\n').count();
        let start = before.rfind('\n').map_or(0, |end| end + 1);
        let column = 1 + before[start..].chars().count();
        let whole: Vec<char> = text[start..].lines().next().unwrap_or_default().chars().collect();
        let from = (column - 1).saturating_sub(AROUND);
        let shown: String =
            whole.iter().skip(from).take(2 * AROUND).map(|c| if *c == '\t' { ' ' } else { *c }).collect();
        let excerpt = format!("    {shown}\n    {}^", " ".repeat(column - 1 - from));
        Self { line, column, excerpt }
    }
}

/// Reads a value from a RON text; `path` is used in messages only.
///
/// # Errors
/// The text exceeds a limit or is not well-formed; fields are unknown, missing or doubled, or values have
/// wrong types, each with its line.
pub fn parse_ron<T: DeserializeOwned>(text: &str, path: &Path) -> Result<T, ScenarioError> {
    check_text(text, path)?;
    let (value, list) = read_all(text, &Fields::of(text));
    match value {
        Some(value) if list.is_empty() => Ok(value),
        _ => Err(ScenarioError::Invalid(Problems { path: path.to_owned(), list })),
    }
}

/// Reads a value from a well-formed text. Fields that do not fit are taken out and reported. No value is
/// returned if such a field has no default.
pub(super) fn read_all<T: DeserializeOwned>(text: &str, fields: &Fields) -> (Option<T>, Vec<Problem>) {
    let (mut rest, mut problems): (String, Vec<Problem>) = (text.to_owned(), Vec::new());
    loop {
        let (error, path) = match read(&rest) {
            Ok(value) => return (Some(value), problems),
            Err(error) => *error,
        };
        let at = offset(&rest, error.span.start.line, error.span.start.col);
        let misfit = Misfit::new(&error.code, &path, (&rest, at), fields);
        let is_known = problems.iter().any(|problem| problem.field == misfit.field);
        if is_known {
            return (None, problems); // it was taken out before, and has no default
        }
        let entry = (misfit.rule != "must be given").then(|| entry_of(&rest, &misfit, fields, at)).flatten();
        let Misfit { field, rule, found, hint } = misfit;
        let line = fields.line(&field).or(Some(error.span.start.line));
        let line = if rule == "must not be given twice" { Some(error.span.start.line) } else { line };
        let field = if field.is_empty() { "the file".to_owned() } else { field };
        problems.push(Problem { field, line, rule, found, hint, file: None });
        let Some(entry) = entry.filter(|_| problems.len() < MOST_MISFITS && text.len() < LARGE_BYTES) else {
            return (None, problems);
        };
        let blank: String = rest[entry.clone()].chars().map(|c| if c == '\n' { '\n' } else { ' ' }).collect();
        let is_as_long = blank.len() == entry.len();
        let blank = if is_as_long { blank } else { " ".repeat(entry.len()) };
        rest.replace_range(entry, &blank);
    }
}

/// Reads a value. An error comes with the path of its field.
pub(super) fn read<T: DeserializeOwned>(text: &str) -> Result<T, Box<(ron::error::SpannedError, String)>> {
    let options = ron_options();
    let mut deserializer = ron::Deserializer::from_str_with_options(text, &options)
        .map_err(|error| Box::new((error, String::new())))?;
    serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
        let path = error.path().to_string();
        Box::new((deserializer.span_error(error.into_inner()), path))
    })
}

/// The number of bytes before a line and a column.
pub(super) fn offset(text: &str, line: usize, column: usize) -> usize {
    let start: usize = text.split_inclusive('\n').take(line - 1).map(str::len).sum();
    let before = text[start..].chars().take(column - 1).map(char::len_utf8).sum::<usize>();
    (start + before).min(text.len())
}

/// The byte range of a field with its name and the comma after it. `None` for an entry of a list, because the
/// numbers of other entries depend on it.
fn entry_of(text: &str, misfit: &Misfit, fields: &Fields, at: usize) -> Option<Range<usize>> {
    let field = misfit.field.as_str();
    let name = field.rsplit('.').next().filter(|name| !name.is_empty() && !name.ends_with(']'))?;
    // If a field is given twice, the second is taken out: reading stopped there.
    let is_doubled = misfit.rule == "must not be given twice";
    let start = if is_doubled { at } else { text[..fields.value(field)?.start].rfind(name)? };
    let value = if is_doubled {
        Fields::of(&format!("({}", &text[start..])).value(name).map(|place| place.end + start - 1)?
    } else {
        fields.value(field)?.end
    };
    let after = text[value..].trim_start();
    let comma = if after.starts_with(',') { text.len() - after.len() + 1 } else { value };
    Some(start..comma)
}
