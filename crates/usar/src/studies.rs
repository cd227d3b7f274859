//! Programs of studies: `usar NAME ..` starts `usar-NAME`, from the folder of this program or from PATH.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use experiments::experiment::SOURCE;
use experiments::{Failure, refuse};
use ron_tree::nearest;

/// The studies of this project, each with what it is.
const STUDIES: [(&str, &str); 2] = [
    ("bench", "How far is each policy from the optimum of a benchmark?"),
    ("yang2021", "The paper that started this laboratory: its claims, readings and calibration"),
];

/// Starts the program that a command line stands for, and returns its exit status; `None` if it stands for a
/// command of this program, or for nothing.
pub(crate) fn start(line: &[OsString], command: &clap::Command) -> Option<Result<u8, Failure>> {
    let words: Vec<&str> = line.iter().skip(1).map_while(|word| word.to_str()).collect();
    match words[..] {
        ["study", name, ..] if of_project(name).is_some() => Some(Err(Failure::input(format!(
            "`usar study {name}` is a program of its own: `usar {name} ..`"
        )))),
        [name, ..]
            if of_project(name).is_some() || is_name(name) && command.find_subcommand(name).is_none() =>
        {
            match (program(name), of_project(name)) {
                (Some(file), _) => Some(run(&file, name, &line[2..])),
                (None, Some(_)) => Some(Err(Failure::input(absent(name)))),
                (None, None) => meant(name, command).map(|study| {
                    let absent = absent(study);
                    Err(Failure::input(format!(
                        "{name} is no command; did you mean `usar {study}`? {absent}"
                    )))
                }),
            }
        }
        _ => None,
    }
}

/// The programs that are there, by their names, each with what it is.
pub(crate) fn present() -> impl Iterator<Item = (&'static str, &'static str)> {
    STUDIES.into_iter().filter(|(name, _)| program(name).is_some())
}

/// The study that is not there and that a mistyped word means, if no command is nearer to it.
fn meant(word: &str, command: &clap::Command) -> Option<&'static str> {
    let names = STUDIES.map(|(study, _)| study);
    let near = nearest(word, command.get_subcommands().map(clap::Command::get_name).chain(names))?;
    names.into_iter().find(|study| *study == near && program(study).is_none() && !Path::new(word).exists())
}

fn of_project(name: &str) -> Option<&'static str> {
    STUDIES.iter().find(|(study, _)| *study == name).map(|(_, about)| *about)
}

fn is_name(word: &str) -> bool {
    let is_letter = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    !word.starts_with('-') && word.chars().all(is_letter)
}

fn absent(name: &str) -> String {
    format!(
        "{name} is a program of its own: cargo install --locked --path studies/{name} (in a clone: cargo run \
         --release -p usar-{name} -- --help)"
    )
}

/// The file of a study's program: beside this one, or in an absolute folder of PATH. A relative folder and an
/// empty one would be the place in which somebody happens to work.
fn program(name: &str) -> Option<PathBuf> {
    let file = format!("usar-{name}{}", std::env::consts::EXE_SUFFIX);
    let own = std::env::current_exe().ok().and_then(|own| own.canonicalize().ok());
    let beside = own.as_deref().and_then(Path::parent).map(Path::to_owned);
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = beside.into_iter().chain(std::env::split_paths(&path));
    folders.filter(|folder| folder.is_absolute()).map(|folder| folder.join(&file)).find(|file| file.is_file())
}

/// Starts a program that was built from the sources of this one.
fn run(file: &Path, name: &str, words: &[OsString]) -> Result<u8, Failure> {
    let cannot = |error| Failure::input(format!("{}: cannot be started: {error}", file.display()));
    let source = Command::new(file).args(["self", "source"]).output().map_err(cannot)?;
    let source = String::from_utf8_lossy(&source.stdout);
    if source.trim() != SOURCE {
        refuse!(
            "{}: was built from other sources than this program, and would give other numbers: build both \
             from one commit (cargo install --locked --path studies/{name})",
            file.display()
        );
    }
    execute(Command::new(file).args(words)).map_err(cannot)
}

/// The program takes the place of this one, so that signals reach it.
#[cfg(unix)]
fn execute(command: &mut Command) -> std::io::Result<u8> {
    Err(std::os::unix::process::CommandExt::exec(command))
}

#[cfg(not(unix))]
fn execute(command: &mut Command) -> std::io::Result<u8> {
    command.status().map(|status| status.code().map_or(1, |code| code as u8))
}
