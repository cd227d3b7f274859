//! `usar scenario draw`: draws the world of a scenario before the trial.

use experiments::experiment::defaults;
use pictures::{Plan, Width, plan};
use recording::World;
use usar_sim::simulation::Simulation;

use crate::arguments::{LookArguments, PictureFile, SetArguments, one_seed};
use crate::library;
use crate::prelude::*;

/// Draw the map of a scenario, before anything runs
#[derive(Debug, Args)]
#[command(after_help = "\
The map has walls, debris, radiation, tasks with those to rescue, rest places, homes, sensing ranges at full \
health, errands, a scale and a legend. What the seed draws has dashed outlines.

Examples:
  usar scenario draw scenarios/paper.ron --out paper.svg
  usar scenario draw scenarios/paper.ron --seed 7 --width 88mm --out paper.png     for a paper's column
  usar scenario draw scenarios/minimal/head_on.ron --no-title --out lane.svg")]
pub(crate) struct Arguments {
    /// Scenario file (RON)
    #[arg(value_parser = library::path)]
    file: PathBuf,
    /// Seed of the trial, or of what is generated [default: the first of the sweep]
    #[arg(long, value_parser = one_seed)]
    seed: Option<u64>,
    #[command(flatten)]
    set: SetArguments,
    /// File or folder to write
    #[arg(long, value_name = "FILE.svg|png")]
    out: PathBuf,
    #[command(flatten)]
    look: LookArguments,
}

impl Arguments {
    pub(crate) fn execute(&self, _: &Registry) -> Result<Report, Failure> {
        let file = PictureFile::of("--out", &self.out, &["svg", "png"], self.look.picture.replace)?;
        let scenario = self.set.load(&self.file)?;
        let seed = match self.seed {
            Some(seed) => seed,
            None => defaults(&self.file)?.1,
        };
        let simulation = Simulation::new(&scenario, seed).map_err(Failure::input_at(self.file.display()))?;
        let world = World::of(&simulation);
        let first_sampled = [simulation.scenario().obstacles().len(), scenario.radiation.len()];
        let is_sampled = world.debris.len() > first_sampled[0] || world.zones.len() > first_sampled[1];
        let title = if is_sampled || scenario.is_drawn() {
            format!("{}, seed {seed}", scenario.name)
        } else {
            scenario.name.clone()
        };
        let drawn = Plan { title: &title, world: &world, errands: &scenario.errands, first_sampled };
        file.write(&plan(&drawn, &self.look.look(Width::Pixels(800))))?;
        Ok(self.out.display().to_string().into())
    }
}
