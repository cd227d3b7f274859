//! The pages for people: links lead somewhere, options exist, every page is in the book, and prose and
//! sources can be read in a window of 110 columns.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::support::{root, rust_files};

/// Pages whose lines may be longer: they are made of comments.
const WIDE: [&str; 2] = ["columns.md", "scenarios-reference.md"];

/// The README, what stands beside it, and the pages of `docs/` and of the studies.
fn pages() -> Vec<(PathBuf, String)> {
    let folders = ["docs", "studies/bench/docs", "studies/yang2021/docs"];
    let docs = folders.into_iter().flat_map(|folder| std::fs::read_dir(root().join(folder)).unwrap());
    let docs = docs.map(|entry| entry.unwrap().path());
    let beside = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md", "CODE_OF_CONDUCT.md"];
    let mut paths: Vec<PathBuf> =
        docs.filter(|path| path.extension().is_some_and(|kind| kind == "md")).collect();
    paths.extend(beside.map(|name| root().join(name)));
    paths.sort();
    assert!(paths.len() > 30);
    let read = |path: PathBuf| (path.clone(), std::fs::read_to_string(path).unwrap());
    paths.into_iter().map(read).collect()
}

/// The lines of a page outside fenced blocks.
fn prose(page: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut is_code = false;
    page.lines().enumerate().filter(move |(_, line)| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        !is_code && !is_fence
    })
}

/// The anchors of a page: its headings in lower case, with hyphens for blanks and without other signs.
fn anchors(page: &str) -> BTreeSet<String> {
    let headings = prose(page).map(|(_, line)| line).filter(|line| line.starts_with('#'));
    let headings = headings.map(|line| line.trim_start_matches('#'));
    let slug = |heading: &str| -> String {
        let kept = heading.trim().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        kept.flat_map(char::to_lowercase).map(|c| if c == ' ' { '-' } else { c }).collect()
    };
    headings.map(slug).collect()
}

/// The targets of links and pictures in a line, without those in code.
fn links(line: &str) -> Vec<&str> {
    let text = line.split('`').step_by(2);
    let targets = text.flat_map(|text| text.split("](").skip(1).filter_map(|rest| rest.split(')').next()));
    targets.filter(|target| !target.contains("://")).collect()
}

/// What is wrong with a link of a page, if anything is.
fn trouble(of: &Path, link: &str) -> Option<String> {
    let (file, anchor) = link.split_once('#').map_or((link, None), |(file, anchor)| (file, Some(anchor)));
    let target = if file.is_empty() { of.to_owned() } else { of.parent()?.join(file) };
    if !target.exists() {
        return Some(format!("{}: {link}: no such file", of.display()));
    }
    let anchor = anchor?;
    let there = anchors(&std::fs::read_to_string(&target).ok()?);
    (!there.contains(anchor))
        .then(|| format!("{}: {link}: no such heading; there are {there:?}", of.display()))
}

#[test]
fn every_link_leads_somewhere() {
    let mut count = 0;
    for (path, page) in pages() {
        // A link may be broken into two lines: the page is looked at as one.
        let text: Vec<&str> = prose(&page).map(|(_, line)| line).collect();
        let text = text.join(" ");
        for link in links(&text) {
            count += 1;
            if let Some(trouble) = trouble(&path, link) {
                panic!("{trouble}");
            }
        }
    }
    assert!(count > 200, "{count} links");
    let readme = root().join("README.md");
    assert!(
        trouble(&readme, "docs/nowhere.md").is_some() && trouble(&readme, "docs/model.md#nowhere").is_some()
    );
    assert_eq!(links("[a](b.md) `[c](d.md)` [e](f.md#g)"), ["b.md", "f.md#g"]);
}

#[test]
fn every_page_is_in_the_book() {
    let summary = std::fs::read_to_string(root().join("docs/SUMMARY.md")).unwrap();
    for (path, _) in pages() {
        let name = path.file_name().unwrap().to_str().unwrap();
        let is_apart = ["SUMMARY.md", "SECURITY.md", "CODE_OF_CONDUCT.md"].contains(&name);
        assert!(is_apart || summary.contains(&format!("{name})")), "docs/SUMMARY.md leaves out {name}");
    }
}

#[test]
fn prose_and_sources_fit_a_window_of_110_columns() {
    let mut wide = Vec::new();
    let mut look = |path: &Path, number: usize, line: &str| {
        let columns = line.chars().count();
        if columns > 110 {
            wide.push(format!("{}:{}: {columns} columns: {line}", path.display(), number + 1));
        }
    };
    for (path, page) in pages() {
        let name = path.file_name().unwrap().to_str().unwrap();
        if WIDE.contains(&name) {
            continue;
        }
        for (number, line) in prose(&page) {
            let is_prose = !line.starts_with(['|', '#', '!', '<']) && line.contains(' ');
            if is_prose {
                look(&path, number, line);
            }
        }
    }
    // rustfmt leaves long texts, comments and tables alone.
    for folder in ["crates", "lab", "python", "studies", "tests"] {
        for (path, text) in rust_files(&root().join(folder)) {
            text.lines().enumerate().for_each(|(number, line)| look(&path, number, line));
        }
    }
    assert!(wide.is_empty(), "{}", wide.join("\n"));
}

/// For each verb, the text of its help.
fn helps() -> BTreeMap<String, String> {
    let page = xtask::manual::commands();
    let sections = page.split("\n## usar ").skip(1);
    sections
        .map(|section| section.split_once('\n').unwrap())
        .map(|(verb, help)| (verb.to_owned(), help.to_owned()))
        .collect()
}

/// The options in a command that its help does not know; the verb, where there is none such.
fn unknown<'c>(command: &'c str, helps: &BTreeMap<String, String>) -> Vec<&'c str> {
    let command = command.split([';', '|', '>', '#']).next().unwrap();
    let words: Vec<&str> = command.split_whitespace().skip(1).collect();
    let first = words.first().copied().unwrap_or_default();
    if root().join("studies").join(first).exists() && !first.is_empty() {
        return Vec::new(); // a program of its own, which its tests run
    }
    let is_verb = first.starts_with(|c: char| c.is_ascii_lowercase());
    // The verb is as many of the words as name one: `cluster submit`.
    let verbs = (1..=words.len().min(3)).rev().map(|count| words[..count].join(" "));
    let help = verbs.into_iter().find_map(|verb| helps.get(&verb));
    let Some(help) = help else { return if is_verb { vec![first] } else { Vec::new() } };
    // Behind `--` are options of other programs.
    let options = words.into_iter().take_while(|word| *word != "--").filter(|word| word.starts_with("--"));
    let names = options.map(|word| word.split(['=', '`', ',', '.', ')']).next().unwrap());
    names.filter(|name| *name != "--help" && !help.contains(&format!("{name} "))).collect()
}

#[test]
fn commands_on_the_pages_have_the_options_of_the_program() {
    let helps = helps();
    let mut count = 0;
    for (path, page) in pages() {
        if path.ends_with("CHANGELOG.md") {
            continue;
        }
        let mut is_shell = false;
        for line in page.lines() {
            if line.starts_with("```") {
                is_shell = !is_shell && ["```sh", "```text"].contains(&line);
            }
            let in_prose = line.split('`').skip(1).step_by(2).filter(|code| code.starts_with("usar "));
            let in_block = (is_shell && line.starts_with("usar ")).then_some(line);
            for command in in_prose.chain(in_block) {
                count += 1;
                let unknown = unknown(command, &helps);
                assert!(unknown.is_empty(), "{}: {command}: {unknown:?} is not known", path.display());
            }
        }
    }
    assert!(count > 100, "{count} commands");
    assert_eq!(unknown("usar sweep x.ron --trails 3 --quiet", &helps), ["--trails"]);
    assert_eq!(unknown("usar swep x.ron", &helps), ["swep"]);
    assert_eq!(unknown("usar cluster submit x.ron --trails 3", &helps), ["--trails"]);
}
