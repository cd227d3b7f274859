//! Tasks of the project itself: `cargo run --release --bin xtask -- TASK [ARGUMENT ...]`, in the
//! project's folder. The justfile lists them with their arguments.

mod commands;

use std::process::ExitCode;

use commands::{
    coverage, golden, man, pages, quiet, reference, results, scale, scenarios, weight, work, worlds,
};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (task, arguments) =
        arguments.split_first().map_or(("", &[][..]), |(task, rest)| (task.as_str(), rest));
    match task {
        "coverage" => coverage::run(arguments),
        "golden" => golden::run(arguments),
        "man" => man::run(arguments),
        "movement" => xtask::movement::main(),
        "navigation" => xtask::navigation::main(),
        "pages" => pages::run(arguments),
        "quiet" => quiet::run(arguments),
        "reference" => reference::run(),
        "results" => results::run(arguments),
        "scenarios" => scenarios::run(arguments),
        "scale" => scale::run(arguments),
        "weight" => weight::run(),
        "work" => work::run(arguments),
        "worlds" => worlds::run(arguments),
        _ => {
            eprintln!(
                "xtask: no task {task:?}. Tasks: coverage, golden, man, movement, \
                 navigation, pages, quiet, reference, results, scale, scenarios, weight, work, worlds"
            );
            ExitCode::from(2)
        }
    }
}
