//! Places of files of the project, and comments as text of pages.

use std::path::{Path, PathBuf};

/// The path of a file of the project.
pub fn place(path: &str) -> PathBuf {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    manifest.ancestors().nth(2).unwrap_or(manifest).join(path)
}

/// A comment in one line.
pub fn on_a_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
