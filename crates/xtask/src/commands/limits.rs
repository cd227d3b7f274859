//! Makes `docs/limits.md` from the constants. Run it in the project's folder.

use std::process::ExitCode;

use xtask::limits;

pub fn run() -> ExitCode {
    std::fs::write(limits::path(), limits::page()).expect("the page can be written");
    println!("written: {}", limits::path().display());
    ExitCode::SUCCESS
}
