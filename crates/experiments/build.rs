//! Tells the laboratory what it was built from: the commit, and a hash of the sources that decide every
//! trial. Results name them. The hash also covers uncommitted sources, because they decide numbers too; it
//! ignores comments and tests, which decide none.
//! Policies bring hashes of their own, so that an edited policy neither builds the laboratory anew nor spoils
//! the results of the others.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The crates that decide the numbers of every trial. Studies hash their own sources.
const DECIDING: [&str; 10] = [
    "ron-tree",
    "rne-core",
    "teaming",
    "scenario",
    "autonomy",
    "frozen-physics",
    "usar-sim",
    "statistics",
    "tables",
    "experiments",
];

fn main() {
    let root = Path::new("../..");
    let mut places: Vec<PathBuf> = vec![root.join("Cargo.lock"), root.join("Cargo.toml")];
    for name in DECIDING {
        let folder = root.join("crates").join(name);
        places.extend([folder.join("Cargo.toml"), folder.join("src")]);
    }
    places.iter().for_each(|place| println!("cargo::rerun-if-changed={}", place.display()));
    println!("cargo::rustc-env=USAR_ENGINE={:016x}", source_hash::hash(root, &places));
    println!("cargo::rustc-env=USAR_COMMIT={}", commit(&places).as_deref().unwrap_or("unknown"));
    let rustc = std::env::var("RUSTC").ok();
    let compiler = rustc.and_then(|rustc| Command::new(rustc).arg("--version").output().ok());
    let compiler = compiler.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
    println!("cargo::rustc-env=USAR_COMPILER={}", compiler.as_deref().unwrap_or("unknown"));
}

/// The commit, with `-dirty` where one of these places was changed.
fn commit(places: &[PathBuf]) -> Option<String> {
    let folder = git(&["rev-parse", "--absolute-git-dir"])?;
    println!("cargo::rerun-if-changed={folder}/logs/HEAD");
    let commit = git(&["rev-parse", "HEAD"])?;
    let mut status = vec!["status", "--porcelain", "--"];
    status.extend(places.iter().filter_map(|place| place.to_str()));
    let is_changed = git(&status).is_none_or(|changes| !changes.is_empty());
    Some(if is_changed { format!("{commit}-dirty") } else { commit })
}

fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
