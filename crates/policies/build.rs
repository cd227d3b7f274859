//! Tells each policy and trust measure the hash of its sources: of its file or folder, and of the files that
//! they share. `src/energy.rs` reads its own as `env!("SOURCES_ENERGY")`.

use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};

/// Texts by which the file of a policy or of a trust measure is known; other files are shared.
const ENTRIES: [&str; 2] = ["pub fn kind() -> PolicyKind", "pub fn measure_kind() -> MeasureKind"];

/// The list of them all, which a new one changes and which decides no answer.
const LIST: &str = "lib.rs";

fn main() {
    println!("cargo::rerun-if-changed=src");
    println!("cargo::rerun-if-changed=Cargo.toml");
    let read = std::fs::read_dir("src").into_iter().flatten().flatten();
    let mut places: Vec<PathBuf> = read.map(|entry| entry.path()).collect();
    places.retain(|path| !path.ends_with(LIST));
    places.sort();
    let (entries, shared): (Vec<PathBuf>, Vec<PathBuf>) = places.into_iter().partition(|path| is_entry(path));
    for entry in entries {
        let mut hasher = DefaultHasher::new();
        shared.iter().chain([&PathBuf::from("Cargo.toml"), &entry]).for_each(|path| add(path, &mut hasher));
        let name = entry.file_stem().unwrap_or_default().to_string_lossy().to_uppercase();
        println!("cargo::rustc-env=SOURCES_{name}={:016x}", hasher.finish());
    }
}

fn is_entry(path: &Path) -> bool {
    let file = if path.is_dir() { path.join("mod.rs") } else { path.to_owned() };
    std::fs::read_to_string(file).is_ok_and(|text| ENTRIES.iter().any(|entry| text.contains(entry)))
}

fn add(path: &Path, hasher: &mut DefaultHasher) {
    if !path.is_dir() {
        (path.to_string_lossy(), std::fs::read(path).unwrap_or_default()).hash(hasher);
        return;
    }
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    files.sort();
    files.iter().for_each(|file| add(file, hasher));
}
