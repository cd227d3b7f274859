//! `usar draw`: draws the world of a scenario before the trial.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use experiments::Failure;
use experiments::experiment::{defaults, with_settings};
use pictures::{Plan, Width, plan};
use recording::World;
use rne_core::Registry;
use usar_sim::simulation::Simulation;

use super::drawn::{Kind, Looks};
use super::{load, output};

/// Draw the map of a scenario, before anything runs
#[derive(Debug, Args)]
#[command(after_help = "\
The map has walls, debris, radiation, tasks with those to rescue, rest places, homes, sensing ranges at full \
health, errands, a scale and a legend. What the seed draws has dashed outlines.

Examples:
  usar draw scenarios/paper.ron --out paper.svg
  usar draw scenarios/paper.ron --seed 7 --width 88mm --out paper.png     a column of a paper, 300 dpi
  usar draw scenarios/minimal/head_on.ron --no-title --out lane.svg")]
pub(crate) struct Arguments {
    /// Scenario file (RON)
    file: PathBuf,
    /// Seed of the trial [default: the first of FILE's sweep file]
    #[arg(long)]
    seed: Option<u64>,
    /// Set a field of the scenario, by its path, to a value in RON; can be given several times
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// The picture to write; it must not exist yet
    #[arg(long, value_name = "FILE.svg|png")]
    out: PathBuf,
    #[command(flatten)]
    looks: Looks,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let kind = Kind::of(&self.out)?;
        let (folder, name) = output::place("--out", &self.out, self.looks.force)?;
        let (scenario, _) = load(&self.file)?;
        let scenario = with_settings(&scenario, &self.set)?;
        let seed = match self.seed {
            Some(seed) => seed,
            None => defaults(&self.file)?.1,
        };
        let simulation = Simulation::new(&scenario, seed)
            .map_err(|error| Failure::input(format!("{}: {error}", self.file.display())))?;
        let world = World::of(&simulation);
        let first_sampled = [simulation.scenario().obstacles().len(), scenario.radiation.len()];
        let is_sampled = world.debris.len() > first_sampled[0] || world.zones.len() > first_sampled[1];
        let title = if is_sampled || scenario.is_drawn() {
            format!("{}, seed {seed}", scenario.name)
        } else {
            scenario.name.clone()
        };
        let drawn = Plan { title: &title, world: &world, errands: &scenario.errands, first_sampled };
        let picture = plan(&drawn, &self.looks.look(Width::Pixels(800)));
        output::write(&folder, name, &kind.content(&picture)?)?;
        Ok(writeln!(out, "{}", self.out.display())?)
    }
}
