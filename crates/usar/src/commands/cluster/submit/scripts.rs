//! The job scripts: bash templates in which words between @ are replaced.

use experiments::Failure;

/// The built-in script of the shards.
pub(super) const ARRAY: &str = include_str!("array.sh");
/// The script of the merge job.
pub(super) const MERGE: &str = include_str!("merge.sh");

/// Fills in a template. A line that consists only of a word with an empty value is left out.
///
/// # Errors
/// A word in the template is unknown.
pub(super) fn fill(template: &str, words: &[(&str, String)]) -> Result<String, Failure> {
    let mut script = String::new();
    for (number, line) in template.lines().enumerate() {
        let filled = fill_line(line, words).map_err(|word| {
            let known: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
            let known = known.join("@, @");
            Failure::input(format!("--template: line {}: @{word}@ must be one of @{known}@", number + 1))
        })?;
        if !filled.is_empty() || line.is_empty() {
            script += &filled;
            script.push('\n');
        }
    }
    Ok(script)
}

fn fill_line(line: &str, words: &[(&str, String)]) -> Result<String, String> {
    let is_word = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_lowercase() || c == '_');
    let mut filled = String::new();
    let mut pieces = line.split('@').peekable();
    filled += pieces.next().unwrap_or_default();
    while let Some(piece) = pieces.next() {
        if pieces.peek().is_none() || !is_word(piece) {
            filled.push('@');
            filled += piece;
            continue;
        }
        let value = words.iter().find(|(word, _)| *word == piece);
        let (_, value) = value.ok_or_else(|| piece.to_owned())?;
        filled += value;
        filled += pieces.next().unwrap_or_default();
    }
    Ok(filled)
}

/// A text quoted as one word of a shell.
pub(crate) fn quoted(text: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./,:=+%".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) {
        return text.to_owned();
    }
    format!("'{}'", text.replace('\'', "'\\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_filled_in_and_nothing_else_is_touched() {
        let words = [("name", "paper".to_owned()), ("none", String::new())];
        let script =
            fill("#SBATCH --signal=B:INT@60\n@none@\n\necho @name@ me@example.org @name@x\n", &words);
        assert_eq!(script.unwrap(), "#SBATCH --signal=B:INT@60\n\necho paper me@example.org paperx\n");
        let unknown = fill("a\n@nmae@\n", &words).unwrap_err().to_string();
        assert_eq!(unknown, "--template: line 2: @nmae@ must be one of @name@, @none@");
        assert_eq!([quoted("a/b.ron"), quoted("it's")], ["a/b.ron", "'it'\\''s'"]);
    }
}
