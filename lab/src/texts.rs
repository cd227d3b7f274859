//! A scenario of the page, with the texts of the files that it may name as its base.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use scenario::{Scenario, ScenarioError, parse_tree};
use serde::Deserialize;

/// A scenario as the page has it.
#[derive(Deserialize)]
pub(crate) struct Texts {
    /// Name of its file, with slashes.
    pub name: String,
    /// Its text.
    pub text: String,
    /// Other files by their names.
    #[serde(default, rename = "texts")]
    others: BTreeMap<String, String>,
}

impl Texts {
    /// The checked scenario.
    pub fn scenario(&self) -> Result<Scenario, ScenarioError> {
        let path = Path::new(&self.name);
        let empty = || ScenarioError::Unreadable { path: path.to_owned(), reason: "is empty".to_owned() };
        if self.text.trim().is_empty() {
            return Err(empty());
        }
        Scenario::parse_from(&self.text, path, &|base| self.read(base))
    }

    fn read(&self, path: &Path) -> Result<String, ScenarioError> {
        let name = plain(path);
        let missing = || {
            let reason = "cannot be read: the page has no such file".to_owned();
            ScenarioError::Unreadable { path: PathBuf::from(&name), reason }
        };
        let own = (name == plain(Path::new(&self.name))).then(|| self.text.clone());
        let text = own.or_else(|| self.others.get(&name).cloned()).ok_or_else(missing)?;
        // All texts of the page are the reader's own: where it breaks is told.
        parse_tree(&text, Path::new(&name))?;
        Ok(text)
    }
}

/// A path without `.` and `..`: that of `gallery/../paper.ron` is `paper.ron`.
pub(crate) fn plain(path: &Path) -> String {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                plain.pop();
            }
            Component::Normal(name) => plain.push(name),
            Component::CurDir | Component::RootDir | Component::Prefix(_) => {}
        }
    }
    plain.to_string_lossy().replace('\\', "/")
}
