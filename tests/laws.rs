//! The laws of the architecture, checked on the sources: no circle of modules, one seam to the engine, no words of one study in the general crates.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::support::root;

/// The crates whose modules must form no circle.
const CRATES: [&str; 4] = ["rne-core", "ron-fields", "usar-sim", "experiments"];

/// The sources of a crate: path from its `src`, and text without tests and comments.
fn sources(name: &str) -> Vec<(PathBuf, String)> {
    let src = root().join("crates").join(name).join("src");
    let mut sources = Vec::new();
    let mut folders = vec![src.clone()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|kind| kind == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                sources.push((path.strip_prefix(&src).unwrap().to_owned(), code(&text)));
            }
        }
    }
    assert!(!sources.is_empty(), "{name} has sources");
    sources.sort();
    sources
}

/// A source without its test module and its comments.
fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
    let is_code = |line: &&str| !line.trim_start().starts_with("//");
    text.lines().filter(is_code).flat_map(|line| [line, "\n"]).collect()
}

/// The top module that a source belongs to.
fn module(path: &Path) -> String {
    let first = path.components().next().unwrap().as_os_str().to_str().unwrap();
    first.trim_end_matches(".rs").to_owned()
}

/// For each top module, the others that it names by `crate::`.
fn uses(sources: &[(PathBuf, String)]) -> BTreeMap<String, BTreeSet<String>> {
    let mut uses: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (path, text) in sources {
        let from = module(path);
        let named = text.split("crate::").skip(1).map(|rest| {
            let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
            rest[..end].to_owned()
        });
        let others = named.filter(|to| *to != from && to.starts_with(|c: char| c.is_lowercase()));
        uses.entry(from.clone()).or_default().extend(others);
    }
    uses.remove("lib");
    uses.remove("main");
    uses
}

/// The modules that are left when all that use none of the others are taken away, again and again: circles, and what uses them.
fn circle(mut uses: BTreeMap<String, BTreeSet<String>>) -> BTreeMap<String, BTreeSet<String>> {
    loop {
        let left: BTreeSet<String> = uses.keys().cloned().collect();
        uses.values_mut().for_each(|to| to.retain(|to| left.contains(to)));
        let before = uses.len();
        uses.retain(|_, to| !to.is_empty());
        if uses.len() == before {
            return uses;
        }
    }
}

#[test]
fn modules_form_no_circle() {
    for name in CRATES {
        let left = circle(uses(&sources(name)));
        assert!(left.is_empty(), "crate {name}: these modules use each other in a circle: {left:#?}");
    }
}

#[test]
fn a_circle_would_be_found() {
    let source = |path: &str, text: &str| (PathBuf::from(path), code(text));
    let apart = [
        source("a/mod.rs", "use crate::b::B;\n// crate::c is only named here\n"),
        source("b.rs", "#[cfg(test)]\nmod tests { use crate::a::A; }"),
    ];
    assert!(circle(uses(&apart)).is_empty());
    let round = [source("a/x.rs", "fn f() { crate::b::g() }"), source("b.rs", "use crate::a;")];
    assert_eq!(circle(uses(&round)).len(), 2);
}

#[test]
fn the_engine_is_named_in_its_seam_only() {
    for name in CRATES {
        for (path, text) in sources(name) {
            let is_seam = name == "usar-sim" && path == Path::new("physics.rs");
            assert!(is_seam || !text.contains("rapier2d"), "{name}/{}: names the engine", path.display());
        }
    }
}

/// Modules of the laboratory that are about one paper.
const STUDY: [&str; 3] = ["claims", "calibration", "readings"];

#[test]
fn the_general_crates_have_no_words_of_one_paper() {
    let words = ["carrier", "supplier", "observer", "hard", "easy"];
    for name in CRATES {
        for (path, text) in sources(name).iter().filter(|(path, _)| !STUDY.contains(&module(path).as_str())) {
            for (number, line) in text.lines().enumerate() {
                let is_word = |word: &str| words.contains(&word.to_lowercase().trim_end_matches('s'));
                let mut found = line.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|w| is_word(w));
                let is_example = line.contains("usar ") || line.contains("--"); // in the help of a command
                if let Some(word) = found.next().filter(|_| !is_example) {
                    panic!(
                        "{name}/{}: line {} of its code says {word:?}: {line}",
                        path.display(),
                        number + 1
                    );
                }
            }
        }
    }
}
