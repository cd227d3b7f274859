//! Small worlds, each with a story that once ended badly, in one test binary.

mod contacts;
mod ending;
mod held_up;
mod radii;
mod rooms;
mod shapes;
mod timeline;

use scenario::Scenario;
use usar_sim::event::Event;
use usar_sim::record::TrialRecord;
use usar_sim::simulation::Simulation;
use usar_sim::world::World;

/// A scenario from a text that lacks name, step and levels.
#[track_caller]
fn scenario(fields: &str) -> Scenario {
    let start = "name: \"story\", dt_s: 0.02, initial_levels: (energy: (mean: 100.0, sd: 0.0), hp: (mean: \
        100.0, sd: 0.0))";
    Scenario::parse(&format!("({start}, {fields})"), "story.ron".as_ref())
        .unwrap_or_else(|error| panic!("{error}"))
}

/// The trial with seed 1, with every invariant checked at every step.
fn trial(scenario: &Scenario, listen: impl FnMut(f64, &[Event], &World)) -> TrialRecord {
    let mut rne = policies::standard().open("RNE").unwrap();
    Simulation::new(scenario, 1).unwrap().checked().run(&mut *rne, listen)
}
