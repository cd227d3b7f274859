//! Compares what comes out of the golden trials with what the repository expects, or renews it.
//!
//! `golden [--write]`

use std::process::ExitCode;

use xtask::golden::{self, Goldens};

pub fn run(arguments: &[String]) -> ExitCode {
    let is_written = arguments.iter().any(|argument| argument == "--write");
    let text = std::fs::read_to_string(golden::path()).expect("the file can be read");
    let (now, expected) = (Goldens::computed(), Goldens::parse(&text).expect("golden trials"));
    if now == expected {
        println!("{} golden trials are as they were", now.count());
        return ExitCode::SUCCESS;
    }
    if let Some(reason) = now.refused_after(&expected) {
        println!("{reason}");
        return ExitCode::FAILURE;
    }
    if is_written {
        std::fs::write(golden::path(), now.to_string()).expect("the file can be written");
        println!("written: {}; say in CHANGELOG.md why numbers change", golden::path().display());
        return ExitCode::SUCCESS;
    }
    println!("the golden trials are not those of {}; `just golden` renews them", golden::path().display());
    ExitCode::FAILURE
}
