//! Makes the numbers of `docs/` anew: runs the command before each block and puts what it prints in its place; figures are copied.
//!
//! `cargo run --release --package experiments --example pages -- [PAGE ...]`, from the project's folder, with the results that the commands name.

#[path = "../tests/pages/mod.rs"]
mod pages;

use std::path::{Path, PathBuf};

fn main() {
    let example = std::env::current_exe().expect("this program has a path");
    let usar = example.ancestors().nth(2).expect("it is in target/PROFILE/examples").join("usar");
    let mut chosen: Vec<PathBuf> = std::env::args().skip(1).map(PathBuf::from).collect();
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
}
