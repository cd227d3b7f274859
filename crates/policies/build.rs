//! Tells each policy and trust measure the hash of its sources: of its file or folder, and of the files that
//! they share. `src/energy.rs` reads its own as `env!("SOURCES_ENERGY")`.

use std::path::{Path, PathBuf};

/// Texts by which the file of a policy or of a trust measure is known; other files are shared.
const ENTRIES: [&str; 2] = ["pub fn kind() -> PolicyKind", "pub fn measure_kind() -> MeasureKind"];

/// The list of them all, which a new one changes and which decides no answer.
const LIST: &str = "lib.rs";

fn main() {
    println!("cargo::rerun-if-changed=src");
    println!("cargo::rerun-if-changed=Cargo.toml");
    let read = std::fs::read_dir("src").into_iter().flatten().flatten();
    let places = read.map(|entry| entry.path()).filter(|path| !path.ends_with(LIST));
    let (entries, mut shared): (Vec<PathBuf>, Vec<PathBuf>) = places.partition(|path| is_entry(path));
    shared.push("Cargo.toml".into());
    for entry in entries {
        let name = entry.file_stem().unwrap_or_default().to_string_lossy().to_uppercase();
        let hash = source_hash::hash(Path::new("."), &[&shared[..], &[entry]].concat());
        println!("cargo::rustc-env=SOURCES_{name}={hash:016x}");
    }
}

fn is_entry(path: &Path) -> bool {
    let file = if path.is_dir() { path.join("mod.rs") } else { path.to_owned() };
    std::fs::read_to_string(file).is_ok_and(|text| ENTRIES.iter().any(|entry| text.contains(entry)))
}
