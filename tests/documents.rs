//! The pages for people: links lead somewhere, options exist, every page is in the book, prose and sources
//! can be read in a window of 110 columns, and the ledger of results tells what numbers are of.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use usar_sim::BITS;
use xtask::results::{self, HEAD, Purpose, Row};
use xtask::verdicts;

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

/// A line as a reader sees it.
fn without_comments(line: &str) -> String {
    let mut parts = line.split("<!-- ");
    let first = parts.next().unwrap_or_default();
    let rest = parts.map(|part| part.split_once(" -->").map_or(part, |(_, rest)| rest));
    std::iter::once(first).chain(rest).collect()
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
                look(&path, number, &without_comments(line));
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

/// Verdicts on seeds that an earlier run had used, from before the ledger or of one study: starts of both
/// names.
const KNOWN_OVERLAPS: [(&str, &str, &str); 9] = [
    ("rivals", "rivals", "nine worlds of one study"),
    ("trust-fresh", "trust-fresh", "seven worlds of one study"),
    ("trust-helped", "trust-fresh", "another policy, and its page says so"),
    ("trust-helped", "trust-helped", "two worlds of one study"),
    ("room-", "room-", "eighteen worlds of one study"),
    ("estimator-options-fresh", "estimator-options-fresh", "five worlds of one study"),
    ("deciders-", "deciders-", "five worlds of one study"),
    ("heard-", "heard-", "five worlds of one study, with and without gossip"),
    ("claims-heard-", "claims-heard-", "two worlds of one study"),
];

/// Seeds of `usar search` by default, with as many trials as it takes; no verdict of a study is on them.
const RESERVED: RangeInclusive<u64> = 400_001..=600_000;

/// Whether two ranges have a seed in common.
fn meet(a: &RangeInclusive<u64>, b: &RangeInclusive<u64>) -> bool {
    a.start() <= b.end() && b.start() <= a.end()
}

/// Whether two rows have a seed in common.
fn share_seeds(row: &Row, earlier: &Row) -> bool {
    row.ranges().iter().any(|a| earlier.ranges().iter().any(|b| meet(a, b)))
}

#[test]
fn verdicts_are_on_seeds_that_no_earlier_run_used() {
    let (rows, mut met) = (results::read(&root()), BTreeSet::new());
    for (i, row) in rows.iter().enumerate().filter(|(_, row)| row.purpose == Purpose::Judge) {
        for earlier in rows[..i].iter().filter(|earlier| share_seeds(row, earlier)) {
            let is_it =
                |(a, b, _): &(&str, &str, &str)| row.output.starts_with(a) && earlier.output.starts_with(b);
            let known = KNOWN_OVERLAPS.iter().position(is_it);
            let (name, seeds) = (&row.output, &row.seeds);
            assert!(known.is_some(), "{name}: seeds {seeds}: {} has used some of them", earlier.output);
            met.extend(known);
        }
        let is_reserved = row.ranges().iter().any(|range| meet(range, &RESERVED));
        assert!(!is_reserved || row.output == "paper-500001", "{}: seeds of `usar search`", row.output);
    }
    assert_eq!(met.len(), KNOWN_OVERLAPS.len(), "an overlap that is known is no more: {met:?}");
    let help = &helps()["search"];
    assert!(["400001", "500001"].iter().all(|seed| help.contains(&format!("[default: {seed}]"))), "{help}");
}

#[test]
fn pages_whose_results_are_older_than_the_program_say_so() {
    let rows = results::read(&root());
    let bits = results::bits_of_pages(&rows);
    let stale = bits.iter().filter(|(_, bits)| **bits < BITS).map(|(page, bits)| format!("{page}: {bits}"));
    let stale: Vec<String> = stale.collect();
    let mut wrong = Vec::new();
    for (path, page) in pages() {
        let place = path.strip_prefix(root()).unwrap().to_str().unwrap();
        let headed = results::headed(&page, bits.get(place).copied());
        if headed != page || headed.matches(&format!("\n{HEAD}")).count() > 1 {
            wrong.push(place.to_owned());
        }
    }
    assert!(
        wrong.is_empty(),
        "the head of {wrong:?} is missing, wrong or left over: `cargo run --bin xtask -- pages` renews it.\n\
         Stale pages, by bits; the program has {BITS}:\n{}",
        stale.join("\n")
    );
    for page in bits.keys() {
        assert!(root().join(page).exists(), "docs/results.csv: {page}: no such page");
    }
    let old = format!("# A\n\n{HEAD}1; the program has {BITS}.\n\nText.\n");
    assert_eq!(results::headed("# A\n\nText.\n", Some(1)), old);
    assert_eq!(results::headed(&old, Some(1)), old);
    assert_eq!(results::headed(&old, Some(BITS)), "# A\n\nText.\n");
    assert_eq!(results::headed(&old, None), "# A\n\nText.\n");
}

#[test]
fn the_ledger_has_every_result_of_a_page_and_commands_that_exist() {
    let (rows, helps) = (results::read(&root()), helps());
    let text = std::fs::read_to_string(root().join("docs/results.csv")).unwrap();
    assert_eq!(results::text(&rows), text, "docs/results.csv is not as the program writes it");
    let outputs: BTreeSet<&str> = rows.iter().map(|row| row.output.as_str()).collect();
    assert_eq!(outputs.len(), rows.len(), "two rows of one output");
    let programs = [r#"{"bits": 12, "seed": 3}"#, r#"{"program": "bits 11, policies 0a"}"#, "{}"];
    assert_eq!(programs.map(results::bits_in), [12, 11, 0]);
    for row in &rows {
        let unknown =
            if row.command.starts_with("usar ") { unknown(&row.command, &helps) } else { Vec::new() };
        assert!(unknown.is_empty(), "docs/results.csv: {}: {unknown:?} is not known", row.output);
        for world in row.world.split(';') {
            assert!(root().join(world).exists(), "docs/results.csv: {}: {world}: no such file", row.output);
        }
    }
    for (path, page) in pages() {
        let place = path.strip_prefix(root()).unwrap().to_str().unwrap();
        for line in
            page.lines().filter(|line| line.starts_with("<!-- $ usar ") || line.starts_with("<!-- copy "))
        {
            for folder in line.split(' ').filter_map(|word| word.strip_prefix("results/")) {
                let is_of = |row: &&Row| format!("{folder}/").starts_with(&format!("{}/", row.output));
                let row = rows.iter().find(is_of).unwrap_or_else(|| panic!("{place}: {folder}: no row"));
                assert!(row.pages().any(|page| page == place), "docs/results.csv: {folder}: not of {place}");
            }
        }
    }
}

/// Words by which a sentence says that one policy does better or worse than another.
const COMPARATIVES: &str = "more less fewer better worse best worst most least above below help helps pay \
    pays save saves cost costs lose loses suffer suffers gain gains equal hurt hurts beat beats down";

/// The paragraphs, list items and headings of a page, without tables and blocks of code.
fn paragraphs(page: &str) -> Vec<String> {
    let mut parts = vec![String::new()];
    for (_, line) in prose(page).filter(|(_, line)| !line.starts_with('|')) {
        if line.is_empty() || line.starts_with(['-', '#']) {
            parts.push(String::new());
        }
        let last = parts.last_mut().unwrap();
        last.push_str(line);
        last.push(' ');
    }
    parts
}

/// The headings and bold sentences of a paragraph.
fn loud(paragraph: &str) -> Vec<&str> {
    let heading = paragraph.starts_with('#').then_some(paragraph);
    heading.into_iter().chain(paragraph.split("**").skip(1).step_by(2)).collect()
}

#[test]
fn headlines_that_compare_policies_are_verdicts_of_rows_that_exist() {
    let registry = policies::standard();
    let estimators = registry.estimators().iter().map(|kind| kind.name.as_str());
    let names: BTreeSet<&str> = registry.names().into_iter().chain(estimators).collect();
    let comparatives: BTreeSet<&str> = COMPARATIVES.split_whitespace().collect();
    let compares = |text: &str| {
        let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
        words.iter().any(|word| names.contains(word)) && words.iter().any(|word| comparatives.contains(word))
    };
    assert!(compares("RNE loses the most.") && !compares("RNE is a policy") && !compares("more"));
    let (mut bare, mut wrong, mut count) = (Vec::new(), Vec::new(), 0);
    for (path, page) in pages().into_iter().filter(|(path, _)| !path.ends_with("CHANGELOG.md")) {
        for paragraph in paragraphs(&page) {
            let is_bare = !paragraph.contains(verdicts::MARK);
            let loud = loud(&paragraph).into_iter().filter(|text| is_bare && compares(text));
            bare.extend(loud.map(|text| format!("{}: {text}", path.display())));
        }
        let (filled, untrue) = verdicts::filled(&page, path.parent().unwrap());
        count += page.matches(verdicts::MARK).count();
        wrong.extend(untrue);
        assert!(filled == page, "{}: a verdict is not as its row: `just pages` renews it", path.display());
    }
    assert!(bare.is_empty(), "a headline about policies needs a verdict:\n{}", bare.join("\n"));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(count > 20, "{count} verdicts");
}
