//! `xtask man FOLDER`: a manual page of each command of `usar`; `xtask man` prints all commands as one page
//! of Markdown, for the book.

use std::path::Path;
use std::process::ExitCode;

use xtask::manual;

pub fn run(arguments: &[String]) -> ExitCode {
    match arguments.first() {
        Some(folder) => manual::write_pages(Path::new(folder)).expect("the pages can be written"),
        None => print!("{}", manual::commands()),
    }
    ExitCode::SUCCESS
}
