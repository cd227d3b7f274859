//! The laws of the architecture, checked on the sources: crates use only those below them, modules and files
//! form no circle, the engine has one seam, the general crates have no words of one
//! paper, the laboratory draws and prints nothing, no parameter is a tuple, and no public error is a text.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::support::{root, rust_files};

/// The crates from the bottom up, in the order of the workspace. Each may use those before it, for its tests
/// as well.
fn crates() -> Vec<String> {
    let workspace = text("Cargo.toml");
    let (_, members) = workspace.split_once("members = [").unwrap();
    let (members, _) = members.split_once(']').unwrap();
    let folder =
        |member: &str| member.strip_prefix("crates/").or(member.strip_prefix("studies/")).map(str::to_owned);
    members.split('"').filter_map(folder).collect()
}

/// The folder of a crate: studies have one of their own.
fn folder(name: &str) -> String {
    let room = if root().join("studies").join(name).exists() { "studies" } else { "crates" };
    format!("{room}/{name}")
}

/// The crates that know a paper, or run as programs.
const APART: [&str; 4] = ["xtask", "usar", "bench", "yang2021"];

/// What is needed to show something to people, and the crates that may need it.
const SCREEN: [(&str, &[&str]); 12] = [
    ("terminal_size", &["usar"]),
    ("resvg", &["pictures"]),
    ("svg2pdf", &["pictures"]),
    ("gif", &["pictures"]),
    ("kuva", &["reports"]),
    ("askama", &["reports", "yang2021"]),
    ("comfy-table", &["tables"]),
    ("clap", &["usar", "xtask", "bench", "yang2021"]),
    ("clap_complete", &["usar"]),
    ("clap_mangen", &["xtask"]),
    ("ctrlc", &["usar"]),
    ("indicatif", &["usar"]),
];

/// A file of the project, by its path from the root.
fn text(path: &str) -> String {
    let path = root().join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// What a manifest says that its package uses, in tests and builds too.
fn dependencies(manifest: &str) -> BTreeSet<&str> {
    let sections = manifest.split("\n[").filter(|section| {
        let name = section.split(']').next().unwrap_or_default();
        name.ends_with("dependencies")
    });
    let lines = sections.flat_map(|section| section.lines().skip(1));
    lines.filter_map(|line| line.split(['.', ' ', '=']).next()).filter(|name| !name.is_empty()).collect()
}

#[test]
fn crates_use_only_those_below_them() {
    let crates = crates();
    for (floor, name) in crates.iter().enumerate() {
        let manifest = text(&format!("{}/Cargo.toml", folder(name)));
        let used = dependencies(&manifest);
        // The tests of the program use the tasks, of which one makes pages of its command line.
        let is_of_tests = |other: &str| (name.as_str(), other) == ("usar", "xtask");
        let used_above = |other: &&String| used.contains(other.as_str()) && !is_of_tests(other);
        let above: Vec<&String> = crates[floor..].iter().filter(used_above).collect();
        assert!(above.is_empty(), "crate {name} uses {above:?}, which are not below it");
    }
}

#[test]
fn every_crate_has_its_floor_and_is_tested_without_a_name() {
    let folders = ["crates", "studies"].map(|room| std::fs::read_dir(root().join(room)).unwrap());
    let folders = folders.into_iter().flatten();
    let found: BTreeSet<String> =
        folders.map(|folder| folder.unwrap().file_name().into_string().unwrap()).collect();
    let crates = crates();
    assert_eq!(found, crates.iter().cloned().collect());
    let workspace = text("Cargo.toml");
    assert!(!workspace.contains("default-members"), "`cargo test` would leave out crates");
    let runs = |name: &&String| text(&format!("{}/Cargo.toml", folder(name))).contains("\ndefault-run = ");
    assert_eq!(crates.iter().filter(runs).collect::<Vec<_>>(), ["usar"], "`cargo run` runs one program");
}

/// Results are refused to a program of other sources: it is known by the sources of all crates that decide
/// numbers, and each policy by its own.
#[test]
fn the_program_is_known_by_the_sources_that_decide_its_numbers() {
    let build = text("crates/experiments/build.rs");
    let others =
        ["source-hash", "recording", "pictures", "exports", "store", "reports", "xtask", "usar", "bench"];
    let with_own_hashes = ["policies", "programs", "yang2021"];
    let known = |name: &&String| with_own_hashes.contains(&name.as_str());
    for name in crates().iter().filter(|name| !known(name) && !others.contains(&name.as_str())) {
        assert!(build.contains(&format!("\"{name}\"")), "crates/experiments/build.rs leaves out {name}");
    }
    for kind in policies::standard().kinds() {
        let made = policies::standard().parse(&kind.name).unwrap();
        assert!(made.fingerprint().is_some(), "{} brings no hash of its sources", kind.name);
    }
    for kind in policies::standard().estimators() {
        let made = policies::standard().estimator(&kind.name).unwrap();
        assert!(made.fingerprint().is_some(), "{} brings no hash of its sources", kind.name);
    }
}

/// A policy's hash covers its own file or folder and what is shared, so that no policy leans on another's
/// file.
#[test]
fn no_policy_names_another_one() {
    let sources = sources("policies");
    let entry =
        |text: &str| text.contains("pub fn kind() -> PolicyKind") || text.contains("-> MeasureKind {");
    let room = |path: &Path| path.components().next().map(|first| first.as_os_str().to_owned());
    let entries: Vec<String> = sources
        .iter()
        .filter(|(_, text)| entry(text))
        .filter_map(|(path, _)| Some(Path::new(&room(path)?).file_stem()?.to_string_lossy().into_owned()))
        .collect();
    assert!(entries.len() >= 5, "{entries:?}");
    for (path, text) in sources.iter().filter(|(path, _)| path != Path::new("lib.rs")) {
        let own = room(path).map(|room| Path::new(&room).file_stem().unwrap_or_default().to_owned());
        for other in entries.iter().filter(|name| own.as_deref() != Some(name.as_ref())) {
            assert!(!text.contains(&format!("crate::{other}")), "policies/{}: {other}", path.display());
        }
    }
}

/// Estimators lean on what they share and not on each other. Of all policies and estimators, only the control
/// `Truth` is told the truth, and `Both`, which may have it as a part.
#[test]
fn no_estimator_names_another_one_and_only_a_control_sees_the_truth() {
    let sources = sources("policies");
    let of_estimators = |(path, _): &&(PathBuf, String)| path.starts_with("estimators");
    let entries: Vec<String> = sources
        .iter()
        .filter(of_estimators)
        .filter(|(_, text)| text.contains("pub fn kind() -> EstimatorKind"))
        .map(|(path, _)| module(path.strip_prefix("estimators").unwrap()))
        .collect();
    assert!(entries.len() >= 14, "{entries:?}");
    let others = |(path, _): &&(PathBuf, String)| path != Path::new("estimators/mod.rs");
    for (path, text) in sources.iter().filter(of_estimators).filter(others) {
        let named = entries.iter().find(|name| {
            let is_word = |rest: &str| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_');
            text.split(&format!("super::{name}")).skip(1).any(is_word)
        });
        assert_eq!(named, None, "policies/{}", path.display());
    }
    let sees = |text: &str| text.contains("Truth<") || text.contains("needs_truth") || text.contains("Told<");
    let seeing: Vec<&PathBuf> = sources.iter().filter(|(_, text)| sees(text)).map(|(path, _)| path).collect();
    assert_eq!(seeing, ["estimators/both.rs", "estimators/truth.rs"].map(Path::new));
}

/// An edited policy builds its crate and the command, and nothing between them.
#[test]
fn only_the_command_is_built_on_policies() {
    for name in crates()
        .iter()
        .filter(|name| !["policies", "usar", "xtask", "bench", "yang2021"].contains(&name.as_str()))
    {
        let manifest = text(&format!("{}/Cargo.toml", folder(name)));
        let dependencies = manifest.split("[dev-dependencies]").next().unwrap_or_default();
        assert!(!dependencies.contains("\npolicies"), "{name} is built on policies");
    }
}

#[test]
fn figures_tables_and_the_command_line_are_left_to_their_crates() {
    for name in &crates() {
        let manifest = text(&format!("{}/Cargo.toml", folder(name)));
        let used = dependencies(&manifest);
        for (library, may) in SCREEN {
            assert!(may.contains(&name.as_str()) || !used.contains(library), "crate {name} uses {library}");
        }
    }
}

#[test]
fn dependencies_of_every_kind_are_found() {
    let manifest = "[package]\nname = \"x\"\n\n[dependencies]\na.workspace = true\n\n[dev-dependencies]\nb \
        = \"1\"\n\n[lints]\nc = 1\n";
    assert_eq!(dependencies(manifest), BTreeSet::from(["a", "b"]));
}

/// The sources of a crate: path from its `src`, and text without tests and comments.
fn sources(name: &str) -> Vec<(PathBuf, String)> {
    let src = root().join(folder(name)).join("src");
    let source = |(path, text): (PathBuf, String)| (path.strip_prefix(&src).unwrap().to_owned(), code(&text));
    let sources: Vec<(PathBuf, String)> = rust_files(&src).into_iter().map(source).collect();
    assert!(!sources.is_empty(), "{name} has sources");
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

/// The modules that are left when all that use none of the others are taken away, again and again: circles,
/// and what uses them.
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
    for name in &crates() {
        let left = circle(uses(&sources(name)));
        assert!(left.is_empty(), "crate {name}: these modules use each other in a circle: {left:#?}");
    }
}

/// Every path that a source names from `crate` or `super` on, with the braces of imports written out. What it
/// only hands on (`pub use`) and names in attributes are left out.
fn paths(text: &str) -> Vec<String> {
    let is_path = |c: char| c.is_alphanumeric() || "_:".contains(c);
    let statements = text.split_inclusive(';').filter(|part| !part.trim_start().starts_with("pub use "));
    let text: String = statements.flat_map(|part| part.split('"').step_by(2)).collect();
    let mut found = Vec::new();
    for (at, _) in text.match_indices("crate::").chain(text.match_indices("super::")) {
        let is_inside = text[..at].ends_with(is_path);
        let rest = &text[at..];
        let end = rest.find(|c| !is_path(c)).unwrap_or(rest.len());
        match rest[end..].starts_with('{') && rest[..end].ends_with("::") {
            _ if is_inside => {}
            false => found.push(rest[..end].to_owned()),
            true => {
                let inside = rest[end + 1..].split('}').next().unwrap_or_default();
                let names = inside.split(|c| !is_path(c)).filter(|name| !name.is_empty());
                found.extend(names.map(|name| format!("{}{name}", &rest[..end])));
            }
        }
    }
    found
}

/// For each source, the other sources of its crate that it names. The `mod.rs` of a folder only hands on what
/// its files define.
fn files_used(sources: &[(PathBuf, String)]) -> BTreeMap<String, BTreeSet<String>> {
    let module = |path: &Path| path.with_extension("").display().to_string().replace("/mod", "");
    let modules: BTreeSet<String> = sources.iter().map(|(path, _)| module(path)).collect();
    let used = |(path, text): &(PathBuf, String)| {
        let own = module(path);
        let target = |named: &String| {
            let mut base: Vec<&str> = own.split('/').collect();
            for step in named.split("::") {
                match step {
                    "crate" => base.clear(),
                    "super" => drop(base.pop()),
                    step => base.push(step),
                }
            }
            let ends = (1..=base.len()).rev().map(|end| base[..end].join("/"));
            let target = ends.into_iter().find(|end| modules.contains(end))?;
            (!own.starts_with(&target)).then_some(target)
        };
        (own.clone(), paths(text).iter().filter_map(target).collect())
    };
    sources.iter().map(used).collect()
}

#[test]
fn files_form_no_circle() {
    for name in &crates() {
        let left = circle(files_used(&sources(name)));
        assert!(left.is_empty(), "crate {name}: these files use each other in a circle: {left:#?}");
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
    let files = [
        source("a/mod.rs", "mod x;\nmod y;\npub use x::X;"),
        source("a/x.rs", "use super::y::{self, Y};"),
        source("a/y.rs", "fn f(_: super::x::X) {}"),
        source("b.rs", "use crate::a::x::X;"),
    ];
    assert_eq!(circle(files_used(&files)).len(), 3, "x and y, and b, which uses them");
    assert!(circle(files_used(&files[..2])).is_empty());
}

#[test]
fn the_engine_is_named_in_its_seam_only() {
    for name in &crates() {
        for (path, text) in sources(name) {
            let is_seam = name == "frozen-physics" || (name == "usar-sim" && path == Path::new("physics.rs"));
            assert!(is_seam || !text.contains("rapier2d"), "{name}/{}: names the engine", path.display());
        }
    }
}

#[test]
fn libraries_keep_no_registry_for_the_process_and_set_no_panic_hook() {
    for name in &crates() {
        for (path, text) in sources(name) {
            let kept = text.lines().find(|line| {
                let is_static = line.trim_start().trim_start_matches("pub ").starts_with("static ");
                is_static && line.contains("Registry")
            });
            assert_eq!(kept, None, "{name}/{}", path.display());
            let is_program = ["usar", "xtask"].contains(&name.as_str());
            assert!(is_program || !text.contains("set_hook("), "{name}/{}: sets a hook", path.display());
        }
    }
}

/// A new activity or statement must be looked at wherever something is decided.
#[test]
fn no_decision_ignores_what_it_does_not_name() {
    let is_of_step = |(path, _): &(PathBuf, String)| path.starts_with("simulation");
    let steps = sources("usar-sim").into_iter().filter(is_of_step);
    for (path, text) in sources("autonomy").into_iter().chain(steps) {
        assert!(!text.contains("_ => {}"), "{}: `_ => {{}}`", path.display());
    }
}

#[test]
fn the_general_crates_have_no_words_of_one_paper() {
    let words = ["carrier", "supplier", "observer", "hard", "easy"];
    for name in crates().iter().filter(|name| !APART.contains(&name.as_str())) {
        for (path, text) in sources(name) {
            for (number, line) in text.lines().enumerate() {
                let is_word = |word: &&str| words.contains(&word.to_lowercase().trim_end_matches('s'));
                let mut found = line.split(|c: char| !c.is_alphanumeric() && c != '_').filter(is_word);
                if let Some(word) = found.next() {
                    let (file, number) = (path.display(), number + 1);
                    panic!("{name}/{file}: line {number} of its code says {word:?}: {line}");
                }
            }
        }
    }
}

/// Splits a list at its commas, up to the bracket that closes it; returns the place of that bracket as well.
fn entries(list: &str) -> (Vec<&str>, usize) {
    let (mut found, mut start, mut depth) = (Vec::new(), 0, 0);
    for (at, c) in list.char_indices() {
        match c {
            '>' if list[..at].ends_with(['-', '=']) => {}
            '(' | '[' | '{' | '<' => depth += 1,
            ')' | ']' | '}' | '>' if depth > 0 => depth -= 1,
            ')' | ']' | '}' | '>' | ',' if depth == 0 => {
                found.push(list[start..at].trim());
                start = at + 1;
                if c != ',' {
                    return (found, at);
                }
            }
            _ => {}
        }
    }
    (found, list.len())
}

/// Whether a pattern or a type is a tuple (`(`) or an array (`[`), behind references too.
fn is_in(bracket: char, text: &str) -> bool {
    let text = text.trim_start_matches('&');
    let text = text.strip_prefix('\'').and_then(|text| text.split_once(' ')).map_or(text, |(_, rest)| rest);
    let text = text.trim_start_matches("mut ");
    text.starts_with(bracket) && !["()", "(dyn ", "(impl "].iter().any(|other| text.starts_with(other))
}

/// The functions of a source with a parameter that is a tuple, or with more than five parameters if those in
/// an array that is taken apart are counted one by one.
fn functions_with_tuples(text: &str) -> Vec<&str> {
    let is_tuple = |(pattern, kind): &(&str, &str)| is_in('(', pattern) || is_in('(', kind);
    let count = |(pattern, kind): &(&str, &str)| {
        if is_in('[', pattern) && is_in('[', kind) { entries(&pattern[1..]).0.len() } else { 1 }
    };
    let end_of_name = |rest: &str| rest.find(['(', '<']).unwrap_or(rest.len());
    let is_offender = |rest: &&str| {
        let after_name = &rest[end_of_name(rest)..];
        let generics = after_name.strip_prefix('<').map_or(0, |generics| entries(generics).1 + 2);
        let Some((_, list)) = after_name[generics..].split_once('(') else { return false };
        let parameters = entries(list).0.into_iter().filter(|parameter| !parameter.is_empty());
        let parameters: Vec<_> =
            parameters.map(|parameter| parameter.split_once(": ").unwrap_or((parameter, ""))).collect();
        parameters.iter().any(is_tuple) || parameters.iter().map(count).sum::<usize>() > 5
    };
    let functions = text.match_indices("fn ").filter(|(at, _)| !text[..*at].ends_with(char::is_alphanumeric));
    let named = functions.map(|(at, word)| &text[at + word.len()..]).filter(is_offender);
    named.map(|rest| &rest[..end_of_name(rest)]).collect()
}

/// The sources, but for those that may, in which something is found, with what is found.
fn offenders(find: fn(&str) -> Vec<&str>, may: &[&str]) -> Vec<String> {
    let all = crates().into_iter().flat_map(|name| {
        let sources = sources(&name).into_iter();
        sources.map(move |(path, text)| (format!("{name}/{}", path.display()), text))
    });
    let others = all.filter(|(file, _)| !may.contains(&file.as_str()));
    let found = others.map(|(file, text)| (file, find(&text).join(", ")));
    found.filter(|(_, found)| !found.is_empty()).map(|(file, found)| format!("{file}: {found}")).collect()
}

#[test]
fn no_parameter_is_a_tuple() {
    let found = offenders(functions_with_tuples, &[]);
    assert!(found.is_empty(), "these functions bundle parameters: {found:#?}");
}

/// The public functions, types and fields of a source, and its implementations of traits, whose error is a
/// text.
fn texts_for_errors(text: &str) -> Vec<&str> {
    let has_text = |item: &&str| {
        let mut results = item.match_indices("Result<").map(|(at, word)| &item[at + word.len()..]);
        let is_associated = ["type Err = String;", "type Error = String;"].contains(item);
        is_associated
            || item.starts_with("pub ") && results.any(|rest| entries(rest).0.get(1) == Some(&"String"))
    };
    let starts = text.match_indices('\n').map(|(at, _)| text[at + 1..].trim_start_matches(' '));
    let items = starts.map(|rest| {
        let line = rest.lines().next().unwrap_or_default();
        let end = if line.contains("fn ") { rest.find(['{', ';']) } else { None };
        end.map_or(line, |end| &rest[..end])
    });
    items.filter(has_text).collect()
}

#[test]
fn no_public_result_has_a_text_for_an_error() {
    let found = offenders(texts_for_errors, &[]);
    assert!(found.is_empty(), "these errors are texts: {found:#?}");
}

#[test]
fn a_tuple_and_a_text_for_an_error_would_be_found() {
    let tuples = "
        fn a((x, y): (f64, f64)) {}
        fn b<F: Fn(u8) -> u8>(&self, of: F, pair: &mut (u8, Vec<u8>)) {}
        fn c([a, b]: [u8; 2], [c, d]: [u8; 2], e: u8, f: u8) {}
        fn d<'a>(pair: &'a (u8, u8)) {}
        fn right([x, y]: [f64; 2], it: &(dyn Any + Send), each: impl Fn((u8, u8)), _: &[(u8, u8)]) {}
        fn unit(done: ()) -> (u8, u8) { f((1, 2)) }";
    assert_eq!(functions_with_tuples(tuples), ["a", "b", "c", "d"]);
    let texts = "

        pub fn a(
            text: &str,
        ) -> Result<Vec<(u8, u8)>, String> {}
        pub type B = Result<(), String>;
        pub c: Result<u8, String>,
        type Err = String;
        pub fn right(text: &str) -> Result<String, Failure> { let _: Result<u8, String>; }
        fn private() -> Result<(), String> {}";
    assert_eq!(texts_for_errors(texts).len(), 4, "{:#?}", texts_for_errors(texts));
}
