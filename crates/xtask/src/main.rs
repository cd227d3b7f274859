//! Tasks of the project itself: `cargo run --release --bin xtask -- TASK [ARGUMENT ...]`, in the
//! project's folder. The justfile lists them with their arguments.

mod commands;

use std::process::ExitCode;

use commands::{
    coverage, damage, golden, kills, limits, mutations, pages, quiet, reference, scale, scenarios, soak,
    work, worlds,
};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (task, arguments) =
        arguments.split_first().map_or(("", &[][..]), |(task, rest)| (task.as_str(), rest));
    match task {
        "coverage" => coverage::run(arguments),
        "damage" => damage::run(arguments),
        "golden" => golden::run(arguments),
        "kills" => kills::run(arguments),
        "mutations" => mutations::run(arguments),
        "limits" => limits::run(),
        "movement" => xtask::movement::main(),
        "navigation" => xtask::navigation::main(),
        "pages" => pages::run(arguments),
        "quiet" => quiet::run(arguments),
        "reference" => reference::run(),
        "scenarios" => scenarios::run(arguments),
        "scale" => scale::run(arguments),
        "soak" => soak::run(arguments),
        "work" => work::run(arguments),
        "worlds" => worlds::run(arguments),
        _ => {
            eprintln!(
                "xtask: no task {task:?}. Tasks: coverage, damage, golden, kills, limits, movement, \
                 mutations, navigation, pages, quiet, reference, scale, scenarios, soak, work, worlds"
            );
            ExitCode::from(2)
        }
    }
}
