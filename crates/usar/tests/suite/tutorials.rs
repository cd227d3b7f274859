//! The pages for people: their files are written, their commands run in order, and in tutorials what they
//! print is compared with the page.

use std::path::Path;
use std::process::Command;

use crate::support::{program, read, root, succeeds, usar};

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

/// Pages whose blocks `text` after commands show what the last one prints.
const SHOWING: [&str; 6] = ["start.md", "trust.md", "policies.md", "programs.md", "results.md", "study.md"];

/// Commands that take minutes, and those that need what such a command writes, by a part of them.
const LONG: [&str; 13] = [
    "usar study",
    "usar search",
    "usar bench",
    "usar sweep scenarios/sweeps/",
    "usar yang2021 claims",
    "--trials 100",
    "--then RNE",
    "results/energy",
    "results/many",
    "results/readings",
    "results/right-of-way",
    "results/what-matters",
    "results/paper-search",
];

/// The commands of a block: lines that begin with `usar` or `python3`, with those that they are continued on.
fn commands(block: &Block) -> Vec<String> {
    let text = block.text.replace("\\\n", "");
    let commands = text.lines().filter(|line| line.starts_with("usar ") || line.starts_with("python3 "));
    commands.filter(|line| !line.contains(" FILE ") && !line.contains("/NAME ")).map(str::to_owned).collect()
}

/// Runs a command line as it stands on a page. No browser opens.
fn play(here: &Path, line: &str) -> String {
    let line = match line.strip_prefix("usar view ") {
        Some(rest) if !rest.contains("--at ") => format!("usar view --no-open {rest}"),
        _ => line.to_owned(),
    };
    let mut path = program().parent().unwrap().as_os_str().to_owned();
    path.push(":");
    path.push(std::env::var_os("PATH").unwrap_or_default());
    let state = env!("CARGO_TARGET_TMPDIR");
    let mut bash = Command::new("bash");
    bash.args(["-c", &line]).current_dir(here).env("PATH", path).env("XDG_STATE_HOME", state);
    let output = bash.output().expect("bash runs");
    assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Follows a page in a folder: writes its files and runs its commands, all or those that are not long. The
/// number of commands that were run.
fn follow(page: &str, here: &Path, with_long: bool) -> usize {
    let (mut printed, mut count) = (String::new(), 0);
    let text = read(&root().join("docs").join(page));
    for block in blocks(&text) {
        let is_shown = SHOWING.contains(&page) && count > 0;
        match (&block.file, block.language.as_str()) {
            (Some(file), _) => std::fs::write(here.join(file), &block.text).unwrap(),
            (None, "text") if is_shown => {
                for line in block.text.lines() {
                    assert!(printed.contains(line), "{page} says {line:?}; printed was\n{printed}");
                }
            }
            (None, "sh" | "text") => {
                for line in commands(&block) {
                    if with_long || !LONG.iter().any(|part| line.contains(part)) {
                        println!("{page}: {line}");
                        printed = play(here, &line);
                        count += 1;
                    }
                }
            }
            _ => {}
        }
    }
    count
}

/// Runs the commands of all pages in the book's order, as somebody who reads it, in one folder that had
/// nothing but `scenarios/`.
fn follow_all(with_long: bool) -> usize {
    let folder = tempfile::tempdir().unwrap();
    copy(&root().join("scenarios"), &folder.path().join("scenarios"));
    let summary = read(&root().join("docs/SUMMARY.md"));
    let pages = summary.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let pages = pages.filter(|page| Path::new(page).extension().is_some_and(|kind| kind == "md"));
    pages.map(|page| follow(page, folder.path(), with_long)).sum()
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let target = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copy(&path, &target);
        } else {
            std::fs::copy(&path, target).unwrap();
        }
    }
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "needs --features full")]
fn the_commands_of_all_pages_run_in_one_folder() {
    assert!(follow_all(false) > 80);
}

#[test]
#[ignore = "an hour: `just commands` runs it"]
fn the_long_commands_of_all_pages_run_too() {
    assert!(follow_all(true) > 100);
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
