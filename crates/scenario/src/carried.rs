//! Files that a program carries with it, under paths of their own: `usar:/paper.ron`.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use ron_tree::file::ReadError;
use ron_tree::nearest;

/// The beginning of the path of a carried file. It cannot be the path of a file on disk by chance.
pub const CARRIED: &str = "usar:/";

/// Names, with slashes, and texts of the files that this program carries.
static FILES: OnceLock<&'static [(&'static str, &'static str)]> = OnceLock::new();

/// Gives the program its files; the first call decides.
pub fn carry(files: &'static [(&'static str, &'static str)]) {
    let _ = FILES.set(files); // a program has one list
}

/// The text of a carried file; `None` for any other path.
pub(super) fn carried(path: &Path) -> Option<&'static str> {
    let name = path.to_str()?.strip_prefix(CARRIED)?;
    FILES.get()?.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// The path that a file names, from the file's own folder; that of a carried file is whole.
pub fn beside(file: &Path, named: &str) -> PathBuf {
    let folder = file.parent().filter(|_| !named.starts_with(CARRIED));
    folder.unwrap_or(Path::new("")).join(named)
}

/// Whether a path is that of a file, on disk or carried.
pub fn is_file(path: &Path) -> bool {
    path.is_file() || carried(path).is_some()
}

/// For a word in the place of a missing file: the carried scenario that is meant, as the end of a sentence;
/// empty if there is none.
pub(super) fn meant(path: &Path, error: &ReadError) -> String {
    let word = path.to_str().filter(|text| !text.contains(['/', '\\', '.']));
    let (Some(word), ReadError::Missing(other)) = (word, error) else { return String::new() };
    let names = FILES
        .get()
        .into_iter()
        .flat_map(|files| files.iter())
        .filter_map(|(name, _)| name.rsplit('/').next().and_then(|last| last.strip_suffix(".ron")));
    let meant = nearest(word, names).filter(|_| other.is_empty());
    meant.map_or(String::new(), |name| format!("; did you mean {name}, which the program carries?"))
}
