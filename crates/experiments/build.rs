//! Tells the program what it was built from: the commit, and a hash of the sources. The manifest of its
//! results names both. The hash also covers uncommitted sources, because they decide numbers too.

use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    let git = |arguments: &[&str]| {
        let output =
            Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
        Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let commit = git(&["describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"]);
    println!("cargo::rustc-env=USAR_COMMIT={}", commit.as_deref().unwrap_or("unknown"));
    println!("cargo::rustc-env=USAR_SOURCE={:016x}", source_hash(Path::new("../..")));
    let compiler =
        std::env::var("RUSTC").ok().and_then(|rustc| Command::new(rustc).arg("--version").output().ok());
    let compiler = compiler.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
    println!("cargo::rustc-env=USAR_COMPILER={}", compiler.as_deref().unwrap_or("unknown"));
    if let Some(folder) = git(&["rev-parse", "--absolute-git-dir"]) {
        println!("cargo::rerun-if-changed={folder}/logs/HEAD");
    }
    for name in CRATES {
        println!("cargo::rerun-if-changed=../{name}/Cargo.toml");
        for folder in ["src", "templates"].map(|folder| format!("../{name}/{folder}")) {
            if Path::new(&folder).exists() {
                println!("cargo::rerun-if-changed={folder}");
            }
        }
    }
    println!("cargo::rerun-if-changed=../../Cargo.lock");
    println!("cargo::rerun-if-changed=../../Cargo.toml");
}

/// The crates that the program consists of, including the crates above this one. Results are refused to a
/// program with other sources.
const CRATES: [&str; 11] = [
    "ron-fields",
    "rne-core",
    "frozen-physics",
    "usar-sim",
    "recording",
    "pictures",
    "exports",
    "experiments",
    "reports",
    "study-yang2021",
    "usar",
];

/// A hash of the manifests, the lock file and all sources of the crates, by path and content.
fn source_hash(root: &Path) -> u64 {
    let mut files = vec![root.join("Cargo.lock"), root.join("Cargo.toml")];
    for name in CRATES {
        files.push(root.join("crates").join(name).join("Cargo.toml"));
        collect(&root.join("crates").join(name).join("src"), &mut files);
    }
    files.sort();
    let mut hasher = DefaultHasher::new();
    for file in files {
        let content = std::fs::read(&file).unwrap_or_default();
        (file.to_string_lossy(), content).hash(&mut hasher);
    }
    hasher.finish()
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() { collect(&path, files) } else { files.push(path) }
    }
}
