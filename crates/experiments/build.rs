//! Tells the program what it was built from: the commit, and hashes of the sources. Results name them. The
//! hashes also cover uncommitted sources, because they decide numbers too.

use std::collections::BTreeMap;
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
    let sources = Sources::under(Path::new("../.."));
    println!("cargo::rustc-env=USAR_ENGINE={:016x}", hash(&sources.engine));
    println!("cargo::rustc-env=USAR_SOURCE={:016x}", hash(&sources.all()));
    let policies = sources.policies.iter().map(|(name, files)| format!("{name}={:016x}", hash(files)));
    println!("cargo::rustc-env=USAR_POLICIES={}", policies.collect::<Vec<_>>().join(";"));
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

/// The crates that the program consists of, including the crates above this one.
const CRATES: [&str; 12] = [
    "ron-fields",
    "rne-core",
    "policies",
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

/// The crates that decide the numbers of a trial, or of a study.
const DECIDING: [&str; 7] =
    ["ron-fields", "rne-core", "policies", "frozen-physics", "usar-sim", "experiments", "study-yang2021"];

/// The folder of the built-in policies, each a file or a folder with its entry for the registry. Its other
/// files are shared by the policies.
const POLICIES: &str = "crates/policies/src";

/// Text by which the file of a policy is known.
const ENTRY: &str = "pub fn kind() -> PolicyKind";

/// The list of the policies, which a new policy changes and which decides no number.
const LISTS: [&str; 1] = ["crates/policies/src/lib.rs"];

/// Path below the project's folder, and content.
type Source = (String, Vec<u8>);

/// The sources that decide numbers.
struct Sources {
    /// Those that decide the numbers of every trial: manifests, the lock file, and all that is no policy.
    engine: Vec<Source>,
    /// Those of each policy, by the name of its file or folder.
    policies: BTreeMap<String, Vec<Source>>,
}

impl Sources {
    fn under(root: &Path) -> Self {
        let mut files = vec![root.join("Cargo.lock"), root.join("Cargo.toml")];
        for name in DECIDING {
            files.push(root.join("crates").join(name).join("Cargo.toml"));
            collect(&root.join("crates").join(name).join("src"), &mut files);
        }
        files.sort();
        let mut sources = Self { engine: Vec::new(), policies: BTreeMap::new() };
        for file in files {
            let path = file.strip_prefix(root).unwrap_or(&file).to_string_lossy().replace('\\', "/");
            let source = (path, std::fs::read(&file).unwrap_or_default());
            match policy_of(root, &source.0) {
                _ if LISTS.contains(&source.0.as_str()) => {}
                Some(policy) => sources.policies.entry(policy).or_default().push(source),
                None => sources.engine.push(source),
            }
        }
        sources
    }

    fn all(&self) -> Vec<Source> {
        self.engine.iter().chain(self.policies.values().flatten()).cloned().collect()
    }
}

/// The policy that a file belongs to, by the name of its file or folder.
fn policy_of(root: &Path, path: &str) -> Option<String> {
    let name = path.strip_prefix(POLICIES)?.strip_prefix('/')?.split('/').next()?;
    let entry = root.join(POLICIES).join(name);
    let entry = if entry.is_dir() { entry.join("mod.rs") } else { entry };
    let is_policy = std::fs::read_to_string(entry).is_ok_and(|text| text.contains(ENTRY));
    is_policy.then(|| name.to_owned())
}

fn hash(sources: &[Source]) -> u64 {
    let mut hasher = DefaultHasher::new();
    sources.hash(&mut hasher);
    hasher.finish()
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() { collect(&path, files) } else { files.push(path) }
    }
}
