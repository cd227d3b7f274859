//! A benchmark of right of way on problems from the literature, and the files in `scenarios/navigation/`
//! that show them.

pub mod problems;
mod table;
pub mod trial;
mod world;

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use experiments::Failure;
use rayon::prelude::*;
use serde::Serialize;

use crate::docs::place;
use problems::Problem;
use table::Table;
use trial::Outcome;

/// The seed of the instances in `scenarios/navigation/`.
pub const FILE_SEED: u64 = 1;

/// How well robots pass one another: problems of the literature, each with several seeds.
#[derive(Parser)]
#[command(name = "navigation", after_help = AFTER_HELP)]
struct Options {
    /// Seeds 1 to N of each problem
    #[arg(long, value_name = "N", default_value_t = 20)]
    seeds: u64,
    /// This seed only
    #[arg(long, value_name = "SEED", conflicts_with = "seeds")]
    seed: Option<u64>,
    /// Only these problems; `circle*` stands for all that begin like this
    #[arg(long, value_name = "NAME", num_args = 1..)]
    problem: Vec<String>,
    /// Sets `conflicts.resolver`
    #[arg(long, value_name = "R")]
    resolver: Option<String>,
    /// Sets a field of every scenario, as in `conflicts.priority=LowestHpFirst`
    #[arg(long, value_name = "FIELD=VALUE")]
    set: Vec<String>,
    /// Writes `scenarios/navigation/` instead: seed 1 of each problem
    #[arg(long)]
    write: bool,
    /// Writes the instances for other programs instead, one line of JSON for each
    #[arg(long, value_name = "FILE")]
    worlds: Option<PathBuf>,
    /// Lists the problems instead
    #[arg(long)]
    list: bool,
}

const AFTER_HELP: &str = "\
flow: the sum of arrival times by the sum of the times that each robot needs alone. A robot that does not \
arrive counts with the limit, five times the longest time alone and half a minute.
ok: share of the trials in which all arrived and no bodies overlapped by more than a centimetre.
peer: the least flow of ORCA, HRVO or HL, by their libraries, if ok in all trials (crates/xtask/peers).
given up: places given up, as unreachable or without progress, in all trials.
touches: times that a robot came to touch another, for each robot.

Examples:
  navigation --problem circle_16 doorway* --seeds 5
  navigation --resolver None";

/// Runs the command with the arguments of the program.
pub fn main() -> ExitCode {
    let options = Options::parse_from(std::env::args().skip(1));
    match options.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("navigation: {reason}");
            ExitCode::FAILURE
        }
    }
}

/// The folder of the instances of seed 1.
pub fn folder() -> PathBuf {
    place("scenarios/navigation")
}

impl Options {
    fn run(&self) -> Result<(), Failure> {
        let problems = self.problems()?;
        if self.list {
            problems.iter().for_each(|problem| println!("{:16} {}", problem.name, problem.what));
            return Ok(());
        }
        if self.write {
            return write(&problems);
        }
        let seeds = self.seed.map_or(1..=self.seeds, |seed| seed..=seed);
        if let Some(file) = &self.worlds {
            return write_worlds(file, &problems, &seeds);
        }
        let mut changes = Vec::new();
        for change in &self.set {
            let bad = || Failure::input(format!("--set {change}: expected FIELD=VALUE"));
            let (field, value) = change.split_once('=').ok_or_else(bad)?;
            changes.push((field.to_owned(), value.to_owned()));
        }
        changes.extend(self.resolver.iter().map(|name| ("conflicts.resolver".to_owned(), name.clone())));
        let mut table = Table::new()?;
        for problem in &problems {
            let run = |seed| trial::run(problem, seed, &changes);
            let outcomes: Result<Vec<Outcome>, Failure> = seeds.clone().into_par_iter().map(run).collect();
            table.add(problem, &outcomes?);
        }
        table.finish();
        Ok(())
    }

    fn problems(&self) -> Result<Vec<Problem>, Failure> {
        let is_named = |problem: &Problem, name: &str| match name.strip_suffix('*') {
            Some(start) => problem.name.starts_with(start),
            None => problem.name == name,
        };
        let mut problems = problems::problems();
        let unknown = |name: &&String| !problems.iter().any(|problem| is_named(problem, name));
        if let Some(name) = self.problem.iter().find(unknown) {
            return Err(Failure::input(format!("no problem {name:?}; `--list` lists them")));
        }
        let is_wanted = |problem: &Problem| {
            self.problem.is_empty() || self.problem.iter().any(|name| is_named(problem, name))
        };
        problems.retain(is_wanted);
        Ok(problems)
    }
}

fn write(problems: &[Problem]) -> Result<(), Failure> {
    std::fs::create_dir_all(folder()).map_err(Failure::storage)?;
    for problem in problems {
        let path = folder().join(format!("{}.ron", problem.name));
        std::fs::write(&path, problem.text(FILE_SEED))
            .map_err(|error| Failure::storage(format!("{}: {error}", path.display())))?;
    }
    Ok(())
}

/// An instance of a problem, for programs that try other methods on it.
#[derive(Serialize)]
struct Instance<'p> {
    problem: &'p str,
    seed: u64,
    radius_m: f64,
    speed_mps: f64,
    #[serde(flatten)]
    world: world::World,
}

fn write_worlds(file: &Path, problems: &[Problem], seeds: &RangeInclusive<u64>) -> Result<(), Failure> {
    let mut text = String::new();
    for problem in problems {
        for seed in seeds.clone() {
            let (radius_m, speed_mps) = (world::RADIUS_M, world::SPEED_MPS);
            let world = problem.world(seed);
            let instance = Instance { problem: &problem.name, seed, radius_m, speed_mps, world };
            text += &serde_json::to_string(&instance).map_err(Failure::run)?;
            text += "\n";
        }
    }
    std::fs::write(file, text).map_err(|error| Failure::storage(format!("{}: {error}", file.display())))
}
