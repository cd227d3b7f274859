//! What the project weighs, by package, beside the ceiling in `crates/xtask/ceiling.ron`. Run it in the
//! project's folder.

use std::process::ExitCode;

use xtask::weight::{Ceiling, Lines, Weight};

pub fn run() -> ExitCode {
    let root = std::env::current_dir().expect("there is a working folder");
    let (weight, ceiling) = (Weight::of(&root), Ceiling::read(&root));
    println!("{:30}{:>8}{:>8}{:>10}", "lines of Rust", "code", "tests", "comments");
    for (package, (lines, is_built)) in &weight.packages {
        row(&format!("{package}{}", if *is_built { "" } else { " *" }), *lines);
    }
    row("all", weight.packages.values().map(|(lines, _)| *lines).sum());
    println!(
        "{:30}{:>8}    (of `cargo run`: without those with a star)\n",
        "built",
        weight.code(|built| built)
    );
    for (folder, lines) in &weight.scripts {
        row(&format!("{folder}, other languages"), *lines);
    }
    for (folder, words) in &weight.words {
        println!("{:30}{words:>8}", format!("words in {}", if folder.is_empty() { "." } else { folder }));
    }
    println!("{:30}{:>8}", "words, but for studies", weight.words());
    println!("{:30}{:>8}", "commands of usar", weight.commands[0]);
    println!("{:30}{:>8}", "options of them", weight.commands[1]);
    println!("{:30}{:>8}", "packages of `cargo run`", weight.others[0]);
    println!("{:30}{:>8}", "packages in Cargo.lock", weight.others[1]);
    let broken = ceiling.broken_by(&weight);
    broken.iter().for_each(|sentence| eprintln!("crates/xtask/ceiling.ron: {sentence}"));
    if broken.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn row(name: &str, lines: Lines) {
    println!("{name:30}{:>8}{:>8}{:>10}", lines.code, lines.tests, lines.comments);
}
