//! Makes the numbers of `docs/` anew: runs the command before each block and puts what it prints in its
//! place; figures are copied.
//!
//! `pages [PAGE ...]`, from the project's folder, with the results that the commands name and `usar` built in
//! the same profile.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use xtask::pages;

pub fn run(arguments: &[String]) -> ExitCode {
    let usar = super::usar();
    let mut chosen: Vec<PathBuf> = arguments.iter().map(PathBuf::from).collect();
    if chosen.is_empty() {
        let docs = std::fs::read_dir("docs").expect("the folder docs").flatten().map(|entry| entry.path());
        chosen.extend(docs.filter(|path| path.extension().is_some_and(|kind| kind == "md")));
        chosen.sort();
    }
    for path in chosen {
        let page = std::fs::read_to_string(&path).expect("a page");
        if !page.contains(pages::MARK) {
            continue;
        }
        let new = pages::renewed(&page, |command| {
            eprintln!("{}: usar {command}", path.display());
            Some(pages::answer(&usar, Path::new("."), command))
        });
        // `<!-- copy FROM TO -->`: a figure, from the results to a place beside the page.
        for line in page.lines().filter_map(|line| line.strip_prefix("<!-- copy ")?.strip_suffix(" -->")) {
            let (from, to) = line.split_once(' ').expect("two names");
            std::fs::copy(from, Path::new("docs").join(to)).expect("the figure is there");
        }
        let is_same = new == page;
        std::fs::write(&path, new).expect("the page can be written");
        println!("{}: {}", path.display(), if is_same { "as it was" } else { "renewed" });
    }
    ExitCode::SUCCESS
}
