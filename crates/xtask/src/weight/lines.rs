//! Lines of one file, sorted.

use std::iter::{Peekable, Sum};
use std::ops::AddAssign;
use std::str::Lines as TextLines;

/// Lines that are not blank.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Lines {
    /// Lines of the product.
    pub code: usize,
    /// Lines of tests.
    pub tests: usize,
    /// Lines that hold a comment alone.
    pub comments: usize,
}

impl AddAssign for Lines {
    fn add_assign(&mut self, other: Self) {
        self.code += other.code;
        self.tests += other.tests;
        self.comments += other.comments;
    }
}

impl Sum for Lines {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |mut sum, lines| {
            sum += lines;
            sum
        })
    }
}

impl Lines {
    /// Counts a file of Rust at this place of the project.
    pub fn of_rust(place: &str, text: &str) -> Self {
        let mut lines = text.lines().peekable();
        let mut counted = Self::default();
        while let Some(line) = lines.next() {
            let word = line.trim();
            if word.starts_with("#[cfg(test)]") {
                counted.tests += item(line, &mut lines);
            } else if word.starts_with("//") {
                counted.comments += 1;
            } else if !word.is_empty() {
                counted.code += 1;
            }
        }
        counted.in_file(place)
    }

    /// Counts a file of TypeScript, Python or shell.
    pub fn of_script(place: &str, text: &str) -> Self {
        let mut counted = Self::default();
        for word in text.lines().map(str::trim).filter(|word| !word.is_empty()) {
            let is_comment = word.starts_with("//") || word.starts_with('#');
            *(if is_comment { &mut counted.comments } else { &mut counted.code }) += 1;
        }
        counted.in_file(place)
    }

    /// The same lines: those of a test file are a test's.
    fn in_file(mut self, place: &str) -> Self {
        let mut folders = place.split('/');
        let name = folders.next_back().unwrap_or_default();
        let is_test = folders.any(|folder| ["tests", "test", "benches"].contains(&folder))
            || name == "tests.rs"
            || name.contains("test_")
            || name.contains(".test.");
        if is_test {
            self.tests += std::mem::take(&mut self.code);
        }
        self
    }
}

/// Takes the item below an attribute, and counts its lines with that of the attribute.
fn item(attribute: &str, lines: &mut Peekable<TextLines>) -> usize {
    let indent = |line: &str| line.len() - line.trim_start().len();
    let mut count = 1;
    for line in lines.by_ref() {
        let word = line.trim();
        count += usize::from(!word.is_empty() && !word.starts_with("//"));
        let is_last = word.ends_with(';') || word.ends_with('}') || word.ends_with("},");
        if indent(line) == indent(attribute) && is_last {
            break;
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::Lines;

    #[test]
    fn an_item_of_tests_is_no_code() {
        let text = "\
//! A file.
use a::b;

#[cfg(test)]
mod tests;

/// Twice.
fn twice(x: u8) -> u8 {
    2 * x // of course
}

#[cfg(test)]
#[expect(dead_code)]
mod more {
    fn f() {
        let _ = 1;
    }
}
";
        let counted = Lines::of_rust("crates/a/src/lib.rs", text);
        assert_eq!(counted, Lines { code: 4, tests: 8, comments: 2 });
        let counted = Lines::of_rust("crates/a/tests/b.rs", text);
        assert_eq!(counted, Lines { code: 0, tests: 12, comments: 2 });
    }
}
