//! Renews the numbers on the pages of `docs/` and of the studies: runs the command before each block and
//! replaces the block by its output. Figures and long tables are copied beside the page. A page whose results
//! are older than the program says so under its title.
//!
//! `pages [PAGE ...]`, in the project's folder, with `usar` built in the same profile. What is made of
//! results that are not there stays as it is, and is named; so is a claim that its row does not show.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use xtask::{pages, results, verdicts};

pub fn run(arguments: &[String]) -> ExitCode {
    let usar = super::usar();
    let mut chosen: Vec<PathBuf> = arguments.iter().map(PathBuf::from).collect();
    if chosen.is_empty() {
        let folders = ["docs", "studies/bench/docs", "studies/yang2021/docs"];
        let docs = folders.into_iter().flat_map(|folder| std::fs::read_dir(folder).expect("pages").flatten());
        let docs = docs.map(|entry| entry.path());
        chosen.extend(docs.filter(|path| path.extension().is_some_and(|kind| kind == "md")));
        chosen.push("README.md".into());
        chosen.sort();
    }
    let rows = results::read(Path::new("."));
    let bits = results::bits_of_pages(&rows);
    let mut is_true = true;
    for path in chosen {
        let page = std::fs::read_to_string(&path).expect("a page");
        let place = path.strip_prefix(".").unwrap_or(&path).to_str().expect("a name of text");
        let headed = results::headed(&page, bits.get(place).copied());
        let has_marks = [pages::MARK, verdicts::MARK, "<!-- copy "].iter().any(|mark| page.contains(mark));
        if headed == page && !has_marks {
            continue;
        }
        let mut answers = BTreeMap::new();
        let is_there = |command: &str| {
            let mut folders = command.split(' ').filter(|word| word.starts_with("results/"));
            folders.all(|folder| Path::new(folder).exists())
        };
        let new = pages::renewed(&headed, |command| {
            if !is_there(command) {
                eprintln!("{}: left as it is, without results: usar {command}", path.display());
                return None;
            }
            let answer = answers.entry(command.to_owned()).or_insert_with(|| {
                eprintln!("{}: usar {command}", path.display());
                pages::answer(&usar, Path::new("."), command)
            });
            Some(answer.clone())
        });
        // `<!-- copy FROM TO -->` copies a figure or a table from the results to a place beside the page.
        for line in page.lines().filter_map(|line| line.strip_prefix("<!-- copy ")?.strip_suffix(" -->")) {
            let (from, to) = line.split_once(' ').expect("two names");
            match std::fs::read(from) {
                Ok(bytes) => put(&path, to, &bytes),
                Err(error) => eprintln!("{}: left as it is: {from}: {error}", path.display()),
            }
        }
        for (name, text) in &new.files {
            put(&path, name, text.as_bytes());
        }
        let (text, wrong) = verdicts::filled(&new.page, path.parent().unwrap_or(Path::new(".")));
        wrong.iter().for_each(|claim| eprintln!("{}: {claim}", path.display()));
        is_true &= wrong.is_empty();
        let is_same = text == page;
        std::fs::write(&path, text).expect("the page can be written");
        println!("{}: {}", path.display(), if is_same { "as it was" } else { "renewed" });
    }
    if is_true { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Writes a file beside a page.
fn put(page: &Path, name: &str, bytes: &[u8]) {
    let path = page.with_file_name(name);
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("the folder can be made");
    std::fs::write(path, bytes).expect("the file can be written");
}
