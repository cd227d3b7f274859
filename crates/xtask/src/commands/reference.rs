//! Makes `docs/scenarios-reference.md` of the types' comments, and the schemas of scenario and sweep files in `docs/schemas`.

use std::process::ExitCode;

use xtask::reference;

pub fn run() -> ExitCode {
    std::fs::write(reference::path(), reference::page()).expect("the page can be written");
    println!("written: {}", reference::path().display());
    ExitCode::SUCCESS
}
