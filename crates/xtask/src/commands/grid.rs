//! Maps of the grid benchmarks: which robots arrive, and how long they stall.
//!
//! `grid MAP ... [--scen FILE] [--robots N] [--seeds N] [--seconds S] [--out FILE.ron]`

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use experiments::Failure;
use rayon::prelude::*;
use ron_tree::Node;
use xtask::grid::{Agent, Grid};
use xtask::journeys::Journeys;

/// Trials on maps of the grid benchmarks (.map and .scen), a cell a metre
#[derive(Parser)]
#[command(name = "grid", after_help = AFTER_HELP)]
struct Options {
    /// Maps
    #[arg(required = true, value_name = "FILE.map")]
    maps: Vec<PathBuf>,
    /// Agents of the map; without, they are drawn from its largest part
    #[arg(long, value_name = "FILE.scen")]
    scen: Option<PathBuf>,
    /// Robots
    #[arg(long, default_value_t = 100)]
    robots: usize,
    /// Seeds 1 to N
    #[arg(long, default_value_t = 3)]
    seeds: u64,
    /// Duration of a trial
    #[arg(long, default_value_t = 900.0)]
    seconds: f64,
    /// Write the first scenario to this file instead
    #[arg(long, value_name = "FILE.ron")]
    out: Option<PathBuf>,
}

const AFTER_HELP: &str = "\
The maps are published at movingai.com/benchmarks; copies are in many repositories of pathfinders.

Example:
  just grid random-32-32-20.map room-32-32-4.map --robots 100";

pub fn run(arguments: &[String]) -> ExitCode {
    super::silence_triangulations();
    let name = std::iter::once("grid".to_owned());
    match Options::parse_from(name.chain(arguments.iter().cloned())).run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("grid: {reason}");
            ExitCode::from(2)
        }
    }
}

fn read(path: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(path).map_err(|error| Failure::input(format!("{}: {error}", path.display())))
}

impl Options {
    fn run(&self) -> Result<(), Failure> {
        for map in &self.maps {
            let told = |error| Failure::input(format!("{}: {error}", map.display()));
            let grid = Grid::parse(&read(map)?).map_err(told)?;
            let name = map.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
            let agents = |seed: u64| match &self.scen {
                Some(path) => grid.agents(&read(path)?, self.robots).map_err(told),
                None => Ok(grid.drawn(self.robots, seed)),
            };
            if let Some(out) = &self.out {
                let scenario = grid.scenario(&agents(1)?, &name, self.seconds);
                let tree = Node::of(&*scenario).map_err(Failure::run)?;
                return std::fs::write(out, tree.pretty()).map_err(Failure::storage);
            }
            let drawn: Vec<(u64, Vec<Agent>)> =
                (1..=self.seeds).map(|seed| Ok((seed, agents(seed)?))).collect::<Result<_, Failure>>()?;
            let trial = |(seed, agents): &(u64, Vec<Agent>)| {
                let scenario = grid.scenario(agents, &name, self.seconds);
                (*seed, Journeys::run(&scenario, *seed))
            };
            let trials: Vec<_> = drawn.par_iter().map(trial).collect();
            for (seed, journeys) in trials {
                match journeys {
                    Ok(journeys) => println!("{name}, seed {seed}: {}", told_of(&journeys)),
                    Err(error) => println!("{name}, seed {seed}: {error}"),
                }
            }
        }
        Ok(())
    }
}

fn told_of(journeys: &Journeys) -> String {
    let record = &journeys.record;
    format!(
        "{} of {} robots arrived, {} gave up, {} stalled for 30 s or more (longest {:.0} s), {:.0} s, {}",
        record.counts.errands_done,
        record.robots.len(),
        record.counts.unreachable,
        journeys.stalls().count(),
        record.longest_stall_s(),
        record.time_s,
        record.status.name()
    )
}
