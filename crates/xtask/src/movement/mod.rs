//! How the robots of the default right of way move, beside people in experiments and beside the problems of
//! CADRL (docs/movement.md).

pub mod crowd;
pub mod literature;
mod page;
pub mod square;
mod tables;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use experiments::Failure;
use rayon::prelude::*;
use scenario::{LayoutError, Scenario};

use crowd::{Crowd, Passage};
use square::Outcome;

/// Widths of doors, in metres: those of the experiments, and between and beside them.
const WIDTHS_M: [f64; 8] = [0.8, 1.0, 1.2, 1.4, 1.6, 2.0, 2.4, 3.0];

/// Depths of doors, in metres: those of the boards of Hermes 2009 and of the bottleneck of Seyfried 2009.
const DEPTHS_M: [f64; 2] = [1.0, 2.8];

/// Widths of entrance and exit of the corridor, in metres, as in the one-way experiments of Hermes.
const CORRIDORS_M: [[f64; 2]; 7] =
    [[0.8, 1.8], [1.0, 1.8], [1.45, 1.8], [1.8, 1.8], [1.8, 1.2], [1.8, 0.95], [1.8, 0.8]];

/// Numbers of agents in the square.
const AGENTS: [u32; 5] = [2, 4, 6, 8, 10];

/// Robots in a crowd, and the longest time for them to get through, in seconds.
const ROBOTS: u32 = 120;
const LIMIT_S: f64 = 600.0;

/// How robots move, beside people in experiments and beside the problems of CADRL.
#[derive(Parser)]
#[command(name = "movement")]
struct Options {
    /// Seeds 1 to N of each crowd
    #[arg(long, value_name = "N", default_value_t = 5)]
    seeds: u64,
    /// Random cases of the square for each number of agents
    #[arg(long, value_name = "N", default_value_t = 100)]
    cases: u64,
    /// The folder with movement.md, whose tables and figures are renewed; without, tables are printed only
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Writes the cases of the square for other programs instead, one line of JSON for each
    #[arg(long, value_name = "FILE")]
    worlds: Option<PathBuf>,
    /// Writes the first crowd before a door of a metre to this file instead
    #[arg(long, value_name = "FILE.ron")]
    scenario: Option<PathBuf>,
}

/// Crowds of all seeds at a door.
struct AtDoor {
    width_m: f64,
    depth_m: f64,
    passages: Vec<Passage>,
}

/// Crowds of all seeds in a corridor.
struct InCorridor {
    ends_m: [f64; 2],
    passages: Vec<Passage>,
}

/// Cases of a number of agents in a square.
struct InSquare {
    agents: u32,
    outcomes: Vec<Outcome>,
}

/// Everything that was measured.
struct Measured {
    doors: Vec<AtDoor>,
    corridors: Vec<InCorridor>,
    squares: Vec<InSquare>,
}

/// Runs the command with the arguments of the program.
pub fn main() -> ExitCode {
    match Options::parse_from(std::env::args().skip(1)).run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("movement: {reason}");
            ExitCode::FAILURE
        }
    }
}

impl Options {
    fn run(&self) -> Result<(), Failure> {
        if let Some(path) = &self.scenario {
            let file = Crowd::at_door(ROBOTS, 1.0, DEPTHS_M[0]).file(1, LIMIT_S);
            let scenario = Scenario::try_from(file).map_err(|broken| Failure::run(format!("{broken:?}")))?;
            return std::fs::write(path, scenario.resolved()).map_err(Failure::storage);
        }
        if let Some(path) = &self.worlds {
            return self.write_cases(path);
        }
        let measured = self.measured().map_err(Failure::run)?;
        let published = literature::published().map_err(Failure::run)?;
        let powers = literature::powers().map_err(Failure::run)?;
        let peers = literature::peers().map_err(Failure::run)?;
        let mut tables = tables::crowds(&measured, &published);
        tables.extend([tables::square(&measured.squares, &peers), tables::energy(&powers)]);
        for table in &tables {
            println!("{}\n\n{}", table.title, table.rows);
        }
        let Some(folder) = &self.out else { return Ok(()) };
        page::renew(&folder.join("movement.md"), &tables)?;
        page::renew(&folder.join("scenarios.md"), &tables)?;
        for figure in tables::figures(&measured, &published) {
            let path = folder.join("figures").join(figure.name);
            std::fs::write(path, figure.svg).map_err(Failure::storage)?;
        }
        Ok(())
    }

    fn write_cases(&self, path: &Path) -> Result<(), Failure> {
        let mut text = String::new();
        for agents in AGENTS {
            for seed in 1..=self.cases {
                let case = serde_json::json!({ "seed": seed, "agents": square::case(agents, seed) });
                text.extend([case.to_string().as_str(), "\n"]);
            }
        }
        std::fs::write(path, text).map_err(Failure::storage)
    }

    fn measured(&self) -> Result<Measured, LayoutError> {
        let passages = |crowd: Crowd| -> Result<Vec<Passage>, LayoutError> {
            (1..=self.seeds).into_par_iter().map(|seed| crowd.pass(seed, LIMIT_S)).collect()
        };
        let doors = DEPTHS_M.iter().flat_map(|depth| WIDTHS_M.map(|width| [width, *depth]));
        let doors = doors.map(|[width_m, depth_m]| {
            let passages = passages(Crowd::at_door(ROBOTS, width_m, depth_m))?;
            Ok(AtDoor { width_m, depth_m, passages })
        });
        let corridors = CORRIDORS_M.iter().map(|ends| {
            let passages = passages(Crowd::at_corridor(ROBOTS, ends[0], ends[1]))?;
            Ok(InCorridor { ends_m: *ends, passages })
        });
        let squares = AGENTS.iter().map(|agents| {
            let cases = (1..=self.cases).into_par_iter();
            let outcomes = cases.map(|seed| square::run(*agents, seed)).collect::<Result<_, _>>()?;
            Ok(InSquare { agents: *agents, outcomes })
        });
        Ok(Measured {
            doors: doors.collect::<Result<_, LayoutError>>()?,
            corridors: corridors.collect::<Result<_, LayoutError>>()?,
            squares: squares.collect::<Result<_, LayoutError>>()?,
        })
    }
}
