//! Compares the hashes of the small worlds with those in the repository, or renews them.
//!
//! `golden [--write]`

use std::process::ExitCode;

use xtask::golden;

pub fn run(arguments: &[String]) -> ExitCode {
    let hashes = golden::hashes();
    if arguments.iter().any(|argument| argument == "--write") {
        std::fs::write(golden::path(), &hashes).expect("the file can be written");
        println!("written: {}; say in CHANGELOG.md why numbers change", golden::path().display());
        return ExitCode::SUCCESS;
    }
    let expected = std::fs::read_to_string(golden::path()).expect("the file can be read");
    let changed: Vec<&str> =
        hashes.lines().zip(expected.lines()).filter(|(a, b)| a != b).map(|(a, _)| a).collect();
    if changed.is_empty() && hashes.lines().count() == expected.lines().count() {
        println!("{} small worlds have their golden hashes", hashes.lines().count());
        return ExitCode::SUCCESS;
    }
    println!("not the golden hashes: {changed:?}");
    ExitCode::FAILURE
}
