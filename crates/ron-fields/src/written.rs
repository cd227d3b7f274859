//! Replacing values in the text of a file.

use std::ops::Range;

use thiserror::Error;

use crate::Fields;
use crate::set::is_one_value;

/// Why values cannot be replaced in a text.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum WriteError {
    /// A field is not in the text.
    #[error("{path}: is not written in the file; write it there, so that its value can take its place")]
    NotWritten {
        /// The field.
        path: String,
    },
    /// Two of the values have the same place, or one is part of the other.
    #[error("{path}: is set twice, by itself or as a part of another field")]
    SetTwice {
        /// The field that is set twice or is part of another.
        path: String,
    },
    /// The text is not exactly one value.
    #[error("{path}: must be one value in RON, found {found}")]
    Malformed {
        /// The field.
        path: String,
        /// The value as given.
        found: String,
    },
}

/// A value and the bytes that it replaces.
struct Place<'a> {
    bytes: Range<usize>,
    path: &'a str,
    value: &'a str,
}

/// The text of a file with the values of these fields replaced. Each setting is a path and a value in RON.
/// Everything else, including comments, stays unchanged. The types of the values are not checked here, but
/// when the text is read.
///
/// # Errors
/// A field is not in the text or is set twice, or a value is not exactly one value.
pub fn with_values(text: &str, settings: &[(String, String)]) -> Result<String, WriteError> {
    let fields = Fields::of(text);
    let places = settings.iter().map(|(path, value)| place(&fields, path, value));
    let mut places = places.collect::<Result<Vec<Place>, _>>()?;
    places.sort_by_key(|place| place.bytes.start);
    if let Some(pair) = places.windows(2).find(|pair| pair[0].bytes.end > pair[1].bytes.start) {
        return Err(WriteError::SetTwice { path: pair[1].path.to_owned() });
    }
    let mut text = text.to_owned();
    for place in places.into_iter().rev() {
        text.replace_range(place.bytes, place.value);
    }
    Ok(text)
}

fn place<'a>(fields: &Fields, path: &'a str, value: &'a str) -> Result<Place<'a>, WriteError> {
    let value = value.trim();
    let bytes = fields.value(path).ok_or_else(|| WriteError::NotWritten { path: path.to_owned() })?;
    if is_one_value(value) {
        Ok(Place { bytes, path, value })
    } else {
        Err(WriteError::Malformed { path: path.to_owned(), found: value.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(text: &str, settings: &[(&str, &str)]) -> Result<String, String> {
        let settings: Vec<(String, String)> =
            settings.iter().map(|(path, value)| ((*path).to_owned(), (*value).to_owned())).collect();
        with_values(text, &settings).map_err(|error| error.to_string())
    }

    #[test]
    fn values_take_their_places_and_comments_stay() {
        let text = "(\n    a: 1.0, // one\n    b: (c: [2.0, 3.0]), // two\n)";
        let expected = "(\n    a: 0.25, // one\n    b: (c: [2.0, 9.5]), // two\n)";
        assert_eq!(with(text, &[("b.c[1]", "9.5"), ("a", "0.25")]).unwrap(), expected);
        let twice = [("a", "10.25"), ("a", "12.125")];
        assert!(with(text, &twice).unwrap_err().starts_with("a: is set twice"));
        let within = [("b", "(c: [])"), ("b.c[0]", "1.0")];
        assert!(with(text, &within).unwrap_err().starts_with("b.c[0]: is set twice"));
        assert!(with(text, &[("d", "1")]).unwrap_err().starts_with("d: is not written"));
        assert_eq!(
            with(text, &[("a", "1, z: 2")]).unwrap_err(),
            "a: must be one value in RON, found 1, z: 2"
        );
    }

    #[test]
    fn a_comment_right_after_a_value_stays() {
        let text = "(a: Fast /* as can be */, b: Slow // at the end\n)";
        let expected = "(a: Slow /* as can be */, b: Fast // at the end\n)";
        assert_eq!(with(text, &[("a", "Slow"), ("b", " Fast ")]).unwrap(), expected);
    }

    #[test]
    fn entries_are_written_by_their_names() {
        let text = "(tasks: [(name: \"hard\", grid: (1, 2)), (name: \"easy\", grid: (3, 4))]) // two";
        let expected = "(tasks: [(name: \"hard\", grid: (1, 8)), (name: \"easy\", grid: (9, 4))]) // two";
        assert_eq!(
            with(text, &[("tasks.easy.grid[0]", "9"), ("tasks.hard.grid[1]", "8")]).unwrap(),
            expected
        );
        let twice = [("tasks.easy.grid", "(0, 0)"), ("tasks[1].grid", "(0, 0)")];
        assert!(with(text, &twice).unwrap_err().contains("is set twice"));
    }
}
