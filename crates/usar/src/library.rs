//! The scenarios that the program carries, so that it can be tried without a copy of its repository.

use std::convert::Infallible;
use std::path::{Path, PathBuf};

use scenario::{CARRIED, is_file};

/// Texts of files of the folder `scenarios/`, by their names.
macro_rules! files {
    ($($name:literal)*) => {
        &[$(($name, include_str!(concat!("../../../scenarios/", $name)))),*]
    };
}

/// From now on, the scenarios that the program carries can be read by their paths.
pub fn carry() {
    scenario::carry(FILES);
}

/// Names and texts of the carried files: scenarios, and the sweep files that belong to them.
const FILES: &[(&str, &str)] = files![
    "crowded.ron" "crowded.sweep.ron"
    "eight-needs.ron" "eight-needs.sweep.ron"
    "ground-only.ron" "ground-only.sweep.ron"
    "leak.ron" "leak.sweep.ron"
    "paper.ron" "paper.sweep.ron"
    "paper-calibrated.ron" "paper-calibrated.sweep.ron"
    "three-tasks.ron" "three-tasks.sweep.ron"
    "two-aerial-roles.ron" "two-aerial-roles.sweep.ron"
    "warehouse.ron" "warehouse.sweep.ron"
    "trust/aftershocks.ron" "trust/avalanche.ron" "trust/convoy.ron" "trust/flood.ron" "trust/tunnel.ron"
    "gallery/chance.ron" "gallery/collapse.ron" "gallery/corridors.ron" "gallery/failures.ron"
    "gallery/one-task.ron" "gallery/stepping-stones.ron" "gallery/two-camps.ron"
    "gallery/two-hundred.ron"
];

/// The scenario with this name, as its own path or as a word: `paper`, `paper.ron`, `scenarios/paper.ron`.
pub(crate) fn named(name: &str) -> Option<&'static (&'static str, &'static str)> {
    let name = name.strip_prefix("scenarios/").unwrap_or(name);
    let is_named = |file: &str| {
        let last = file.rsplit('/').next().unwrap_or(file);
        [file, last].into_iter().any(|known| known == name || known.strip_suffix(".ron") == Some(name))
    };
    FILES.iter().find(|(file, _)| is_named(file))
}

/// The path of a carried scenario by its name.
#[must_use]
pub fn carried(name: &str) -> Option<PathBuf> {
    named(name).map(|(file, _)| PathBuf::from(format!("{CARRIED}{file}")))
}

/// The names of the carried scenarios, without those of their sweeps, with their texts.
pub(crate) fn scenarios() -> impl Iterator<Item = (&'static str, &'static str)> {
    let name = |file: &'static str| file.rsplit('/').next().and_then(|last| last.strip_suffix(".ron"));
    let all = FILES.iter().filter(|(file, _)| !file.ends_with(".sweep.ron"));
    all.filter_map(move |(file, text)| Some((name(file)?, *text)))
}

/// Parses a path from the command line: what is on disk, or else a carried scenario of that name.
///
/// # Errors
/// None: parsers of arguments may fail.
pub fn path(text: &str) -> Result<PathBuf, Infallible> {
    let path = Path::new(text);
    let carried = if is_file(path) || text.ends_with('/') { None } else { carried(text) };
    Ok(carried.unwrap_or_else(|| path.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scenario_is_named_by_a_word_or_by_its_path() {
        for name in ["collapse", "collapse.ron", "gallery/collapse.ron", "scenarios/gallery/collapse.ron"] {
            assert_eq!(named(name).unwrap().0, "gallery/collapse.ron");
        }
        assert!(named("ollapse.ron").is_none() && named("mine/paper.ron").is_none());
        assert_eq!(path("results/paper").unwrap(), Path::new("results/paper"));
    }

    #[test]
    fn every_scenario_of_the_folder_is_carried() {
        let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios"));
        for folder in ["", "gallery"] {
            for entry in std::fs::read_dir(root.join(folder)).unwrap().flatten() {
                let path = entry.path();
                let name = path.strip_prefix(root).unwrap().to_str().unwrap();
                if path.extension().is_some_and(|kind| kind == "ron") {
                    assert!(FILES.iter().any(|(file, _)| *file == name), "{name}");
                }
            }
        }
    }
}
