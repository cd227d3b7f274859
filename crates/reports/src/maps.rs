//! Maps in a report: the world of a case, and the trajectories of all robots in chosen trials.

use experiments::Failure;
use experiments::experiment::Experiment;
use pictures::{Look, Plan, Width, plan, trails};
use recording::{Recording, World};
use usar_sim::simulation::Simulation;

/// A trial that a report shows.
pub struct ShownTrial {
    /// Label of its policy.
    pub label: String,
    /// Its seed.
    pub seed: u64,
    /// Its recording.
    pub recording: Recording,
    /// Its replay: name and content of the file beside the report's figures.
    pub replay: Option<(String, String)>,
}

/// A map in the report.
pub(crate) struct Map {
    /// Name of its file.
    pub name: String,
    /// Content of the map.
    pub caption: String,
    /// The drawing.
    pub svg: String,
    /// Link to the trial's replay, relative to the report; empty for none.
    pub replay: String,
}

fn look(width: u32) -> Look {
    Look { width: Width::Pixels(width), ..Look::default() }
}

/// The world of a case with the seed of its first trial; `None` if the layout cannot be drawn.
pub(crate) fn world_map(experiment: &Experiment, case: usize) -> Option<Map> {
    let (scenario, seed) = (&experiment.cases[case].scenario, experiment.seed(1));
    let world = World::of(&Simulation::new(scenario, seed).ok()?);
    let first_sampled = [scenario.debris.len(), scenario.radiation.len()];
    let title = format!("{}, seed {seed}", scenario.name);
    let drawn = Plan { title: &title, world: &world, errands: &scenario.errands, first_sampled };
    let caption =
        "The world before anything runs, with the ranges within which robots notice things at full health.";
    Some(Map {
        name: "map".to_owned(),
        caption: caption.to_owned(),
        svg: plan(&drawn, &look(760)).svg().to_owned(),
        replay: String::new(),
    })
}

/// The trajectories of all robots in a trial.
pub(crate) fn trails_map(number: usize, trial: &ShownTrial, plots: &str) -> Result<Map, Failure> {
    let svg = trails(&trial.recording, &look(570)).map_err(Failure::run)?.svg().to_owned();
    let ShownTrial { label, seed, replay, .. } = trial;
    Ok(Map {
        name: format!("ways-{}", number + 1),
        caption: format!("Ways of all robots under {label}, seed {seed}."),
        svg,
        replay: replay.as_ref().map_or(String::new(), |(name, _)| format!("{plots}/{name}")),
    })
}
