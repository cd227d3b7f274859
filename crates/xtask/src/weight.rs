//! What the house weighs: lines of code, tests and comments by crate, words, packages.
//!
//! A line of Rust is a test's if it stands in a `tests` or `benches` folder, in a file `tests.rs`, or in an
//! item under `#[cfg(test)]`. rustfmt indents all files alike, so an item ends with the bracket below its
//! first letter.

mod lines;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

use ron_tree::Node;
use serde::Deserialize;

pub use lines::Lines;

/// Folders of the project that are counted, and where its pages stand.
const FOLDERS: [&str; 8] = [".ci", "crates", "docs", "lab", "python", "studies", "tests", "viewer"];

/// Folders with what others made or a program made.
const MADE: [&str; 5] = ["target", "node_modules", "dist", "results", "assets"];

/// Pages that are made from the code.
const MADE_PAGES: [&str; 5] =
    ["commands.md", "scenarios-reference.md", "columns.md", "events.md", "limits.md"];

/// The most that the project may weigh: `ceiling.ron`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ceiling {
    /// Lines of Rust in all members, without tests, comments and blank lines.
    pub code: usize,
    /// Those of them that `cargo run` builds.
    pub built: usize,
    /// Lines of TypeScript, Python and shell.
    pub scripts: usize,
    /// Words of Markdown that people wrote, but for those of finished studies.
    pub words: usize,
    /// Why a figure was raised: day, what came, what went.
    pub raised: Vec<String>,
}

/// What the project weighs.
#[derive(Clone, Debug, Default)]
pub struct Weight {
    /// Lines of Rust by package, with whether `cargo run` builds it.
    pub packages: BTreeMap<String, (Lines, bool)>,
    /// Lines of TypeScript, Python and shell by folder.
    pub scripts: BTreeMap<String, Lines>,
    /// Words that people wrote by folder.
    pub words: BTreeMap<String, usize>,
    /// Packages of others that `cargo run` builds, and those in `Cargo.lock`.
    pub others: [usize; 2],
    /// Commands of `usar` that do something, and options that they have in all.
    pub commands: [usize; 2],
}

impl Ceiling {
    /// Reads the file.
    pub fn read(root: &Path) -> Self {
        let text =
            std::fs::read_to_string(root.join("crates/xtask/ceiling.ron")).expect("there is a ceiling");
        Node::parse(&text).expect("RON").read_as().expect("a ceiling")
    }

    /// What is above the ceiling, a sentence each.
    pub fn broken_by(&self, weight: &Weight) -> Vec<String> {
        let [code, built] = [weight.code(|_| true), weight.code(|is_built| is_built)];
        let figures = [
            ("code", code, self.code),
            ("built", built, self.built),
            ("scripts", weight.scripts.values().map(|lines| lines.code).sum(), self.scripts),
            ("words", weight.words(), self.words),
        ];
        let above = figures.into_iter().filter(|(_, found, most)| found > most);
        above.map(|(name, found, most)| format!("{name}: {found} is above the ceiling of {most}")).collect()
    }
}

impl Weight {
    /// Counts the project in this folder. `cargo tree` says what is built.
    pub fn of(root: &Path) -> Self {
        let built = built(root);
        let lock = std::fs::read_to_string(root.join("Cargo.lock")).expect("there is a Cargo.lock");
        let mut weight = Self::default();
        let ours = built.iter().filter(|package| package.contains('/')).count();
        weight.others = [built.len() - ours, lock.matches("[[package]]\n").count()];
        weight.commands = commands(&usar::command());
        for folder in FOLDERS {
            weight.add_folder(root, &root.join(folder), &built);
        }
        for file in std::fs::read_dir(root).expect("the project's folder").flatten() {
            weight.add(root, &file.path(), &built);
        }
        weight
    }

    /// Lines of code in the packages of which `cargo run` builds, or not, what is wanted.
    pub fn code(&self, wanted: impl Fn(bool) -> bool) -> usize {
        self.packages.values().filter(|(_, is_built)| wanted(*is_built)).map(|(lines, _)| lines.code).sum()
    }

    /// Words that people wrote, but for those of finished studies.
    pub fn words(&self) -> usize {
        self.words.iter().filter(|(folder, _)| *folder != "studies").map(|(_, words)| words).sum()
    }

    fn add_folder(&mut self, root: &Path, folder: &Path, built: &BTreeSet<String>) {
        let Ok(entries) = std::fs::read_dir(folder) else { return };
        for path in entries.flatten().map(|entry| entry.path()) {
            let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            match path.is_dir() {
                true if MADE.contains(&name) || name.starts_with('.') => {}
                true => self.add_folder(root, &path, built),
                false => self.add(root, &path, built),
            }
        }
    }

    fn add(&mut self, root: &Path, path: &Path, built: &BTreeSet<String>) {
        let place = path.strip_prefix(root).expect("inside").to_str().expect("a name in UTF-8");
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or("sh");
        let folder = place.split_once('/').map_or("", |(folder, _)| folder);
        match ending {
            "rs" => {
                let package = package_of(place);
                let is_built = built.contains(&package);
                let entry = self.packages.entry(package).or_insert((Lines::default(), is_built));
                entry.0 += Lines::of_rust(place, &text(path));
            }
            "md" if !MADE_PAGES.iter().any(|page| place == format!("docs/{page}")) => {
                let page = text(path);
                let seen =
                    page.split("<!--").map(|part| part.split_once("-->").map_or(part, |(_, rest)| rest));
                let words = seen.flat_map(str::split_whitespace).count();
                *self.words.entry(folder.to_owned()).or_default() += words;
            }
            "ts" | "mjs" | "js" | "py" => self.add_script(folder, place, path),
            "sh" if folder == ".ci" => self.add_script(folder, place, path),
            _ => {}
        }
    }

    fn add_script(&mut self, folder: &str, place: &str, path: &Path) {
        *self.scripts.entry(folder.to_owned()).or_default() += Lines::of_script(place, &text(path));
    }
}

/// The commands below this one that do something, and their options.
fn commands(of: &clap::Command) -> [usize; 2] {
    if !of.has_subcommands() {
        return [1, of.get_opts().count()];
    }
    let below = of.get_subcommands().map(commands);
    below.fold([0, 0], |sum, one| [sum[0] + one[0], sum[1] + one[1]])
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The folder of the package that a file belongs to: `crates/store`, `tests`.
fn package_of(place: &str) -> String {
    let depth = if place.starts_with("crates/") || place.starts_with("studies/") { 2 } else { 1 };
    place.split('/').take(depth).collect::<Vec<_>>().join("/")
}

/// What `cargo run` builds: names of packages of others, and folders of ours.
fn built(root: &Path) -> BTreeSet<String> {
    let tree =
        ["tree", "--locked", "--package=usar", "--edges=normal,build", "--prefix=none", "--format={p}"];
    let output = Command::new("cargo").args(tree).current_dir(root).output().expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let root = root.display().to_string();
    let lines = String::from_utf8(output.stdout).expect("UTF-8");
    lines.lines().map(|line| package(line.trim_end_matches(" (*)"), &root)).collect()
}

/// `store v0.1.0 (/path/crates/store)` is `crates/store`, `libm v0.2.16` itself.
fn package(line: &str, root: &str) -> String {
    let folder = line.split_once(root).map(|(_, rest)| rest.trim_matches(['/', ')']).to_owned());
    folder.unwrap_or_else(|| line.to_owned())
}
