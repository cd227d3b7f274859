//! The tutorial pages: their files are written, their commands run in order, and the output is compared
//! with the page.

use std::path::Path;

use crate::support::{read, root, succeeds, usar};

/// A fenced block: its language, its text, and the file named in a comment before it.
struct Block {
    language: String,
    text: String,
    file: Option<String>,
}

fn blocks(page: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let (mut open, mut file) = (false, None);
    for line in page.lines() {
        if let Some(language) = line.strip_prefix("```") {
            open = !open;
            if open {
                blocks.push(Block { language: language.to_owned(), text: String::new(), file: file.take() });
            }
        } else if open {
            let block = blocks.last_mut().unwrap();
            block.text += line;
            block.text += "\n";
        } else if let Some(name) = line.strip_prefix("<!-- file: ") {
            file = name.strip_suffix(" -->").map(str::to_owned);
        }
    }
    blocks
}

/// The words of a command, separated by blanks outside of single quotes, without these and shell comments.
fn words(command: &str) -> Vec<String> {
    let command = command.split(" # ").next().unwrap();
    let mut is_quoted = false;
    let words = command.split(|c: char| {
        is_quoted ^= c == '\'';
        c.is_whitespace() && !is_quoted
    });
    words.filter(|word| !word.is_empty()).map(|word| word.replace('\'', "")).collect()
}

/// Runs a page in a folder that has `scenarios/`. A block `text` after commands must occur in the output of
/// the last one.
fn follow(page: &str) -> usize {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    copy(&root().join("scenarios"), &here.join("scenarios"));
    let (mut printed, mut count) = (String::new(), 0);
    for block in blocks(&read(&root().join("docs").join(page))) {
        match (block.file, block.language.as_str()) {
            (Some(file), _) => std::fs::write(here.join(file), block.text).unwrap(),
            (None, "sh") => {
                for line in block.text.lines() {
                    let words = words(line);
                    assert_eq!(words[0], "usar", "{page}: {line}");
                    let arguments: Vec<&str> = words[1..].iter().map(String::as_str).collect();
                    println!("{page}: {line}");
                    printed = succeeds(&usar(here, &arguments));
                    count += 1;
                }
            }
            (None, "text") if count > 0 => {
                for line in block.text.lines() {
                    assert!(printed.contains(line), "{page} says {line:?}; printed was\n{printed}");
                }
            }
            _ => {}
        }
    }
    count
}

/// Copies the scenarios at the top of their folder; the pages need no others.
fn copy(from: &Path, to: &Path) {
    std::fs::create_dir(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        if path.is_file() {
            std::fs::copy(&path, to.join(path.file_name().unwrap())).unwrap();
        }
    }
}

#[test]
fn the_tutorial_comes_to_what_it_says() {
    assert_eq!(follow("start.md"), 11);
}

#[test]
fn the_guides_run() {
    let pages = ["trust.md", "policies.md", "programs.md", "results.md", "study.md"];
    assert_eq!(pages.map(follow), [2, 2, 5, 4, 3]);
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "needs --features full")]
fn the_guide_to_figures_runs() {
    assert_eq!(follow("paper-figures.md"), 7);
}

/// The front page promises that it needs no copy of the project: its commands run in an empty folder.
#[test]
fn the_front_page_shows_what_is_printed() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let (mut printed, mut shown, mut worlds) = (String::new(), 0, 0);
    for block in blocks(&read(&root().join("README.md"))) {
        match block.language.as_str() {
            "text" => {
                for line in block.text.lines().skip_while(|line| !line.starts_with("$ ")) {
                    if let Some(command) = line.strip_prefix("$ usar ") {
                        let quiet = if command.starts_with("view") { " --no-open" } else { "" };
                        let arguments = words(&format!("{command}{quiet}"));
                        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
                        printed = succeeds(&usar(here, &arguments));
                    } else {
                        assert!(printed.contains(line), "README.md says {line:?}; printed was\n{printed}");
                        shown += 1;
                    }
                }
            }
            "ron" => {
                std::fs::write(here.join("mine.ron"), &block.text).unwrap();
                succeeds(&usar(here, &["check", "mine.ron"]));
                assert!(block.text.lines().count() <= 22, "a world in twenty lines");
                worlds += 1;
            }
            _ => {}
        }
    }
    assert_eq!((shown, worlds), (10, 1));
}
