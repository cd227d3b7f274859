//! Tells each policy, trust measure, estimator and protocol the hash of its sources: of its file or folder,
//! and of the files that they share. `src/energy.rs` reads its own as `env!("SOURCES_ENERGY")`,
//! `src/estimators/brs.rs` as `env!("SOURCES_ESTIMATOR_BRS")`.

use std::path::{Path, PathBuf};

/// Texts by which the file of an entry is known; other files are shared.
const ENTRIES: [&str; 4] = [
    "pub fn kind() -> PolicyKind",
    "pub fn measure_kind() -> MeasureKind",
    "pub fn kind() -> EstimatorKind",
    "pub fn kind() -> ProtocolKind",
];

/// Files that decide no answer: the lists of them all, which a new one changes, and questions for tests.
const LISTS: [&str; 4] = ["lib.rs", "estimators/mod.rs", "protocols/mod.rs", "made_up.rs"];

/// The folders of other kinds. Policies do not lean on them.
const OTHERS: [[&str; 2]; 2] = [["estimators", "ESTIMATOR_"], ["protocols", "PROTOCOL_"]];

fn main() {
    println!("cargo::rerun-if-changed=src");
    println!("cargo::rerun-if-changed=Cargo.toml");
    let mut places = inside("src");
    places.retain(|path| OTHERS.iter().all(|[folder, _]| !path.ends_with(folder)));
    let shared = hash_entries(places, "", vec!["Cargo.toml".into()]);
    for [folder, prefix] in OTHERS {
        hash_entries(inside(&format!("src/{folder}")), prefix, shared.clone());
    }
}

/// What is in a folder, without the lists and the questions for tests.
fn inside(folder: &str) -> Vec<PathBuf> {
    let read = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let places = read.map(|entry| entry.path());
    places.filter(|path| !LISTS.iter().any(|list| path.ends_with(Path::new("src").join(list)))).collect()
}

/// Says the hash of each entry among these places, with what is shared. Returns what is shared.
fn hash_entries(places: Vec<PathBuf>, prefix: &str, mut shared: Vec<PathBuf>) -> Vec<PathBuf> {
    let (entries, others): (Vec<PathBuf>, Vec<PathBuf>) = places.into_iter().partition(|path| is_entry(path));
    shared.extend(others);
    for entry in entries {
        let name = entry.file_stem().unwrap_or_default().to_string_lossy().to_uppercase();
        let hash = source_hash::hash(Path::new("."), &[&shared[..], &[entry]].concat());
        println!("cargo::rustc-env=SOURCES_{prefix}{name}={hash:016x}");
    }
    shared
}

fn is_entry(path: &Path) -> bool {
    let file = if path.is_dir() { path.join("mod.rs") } else { path.to_owned() };
    std::fs::read_to_string(file).is_ok_and(|text| ENTRIES.iter().any(|entry| text.contains(entry)))
}
