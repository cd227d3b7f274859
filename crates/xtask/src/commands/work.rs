//! Fixed workloads whose instructions are counted: `just instructions`.
//!
//! `work trial|grouping`

use std::process::ExitCode;

use rne_core::{Asked, Session};
use usar_sim::scenario::Scenario;
use usar_sim::simulation::Simulation;
use xtask::team;

/// Steps of half a minute of the paper's mission.
const STEPS: u32 = 1_500;

pub fn run(arguments: &[String]) -> ExitCode {
    match arguments.first().map(String::as_str) {
        Some("trial") => trial(),
        Some("grouping") => grouping(),
        _ => panic!("say which: trial or grouping"),
    }
    ExitCode::SUCCESS
}

fn trial() {
    let (scenario, _) = Scenario::load("scenarios/paper.ron".as_ref()).expect("run from the project's root");
    let mut rne = rne();
    let mut trial = Simulation::new(&scenario, 1).expect("drawn");
    (0..STEPS).for_each(|_| assert_eq!(trial.step(&mut *rne), None));
    println!("{}", trial.finish().state_hash);
}

fn rne() -> Box<dyn Session> {
    policies::standard().open("RNE").expect("known")
}

/// Searches for the best split of a role: 20 robots, the largest number that is exact, and 60 robots by
/// local search.
fn grouping() {
    let mut rne = rne();
    for carriers in [20, 60] {
        let decision = rne.decide(&Asked::of(&team::question([carriers, 0, 0], 2)));
        println!("{:?}", decision.expect("a decision").assignment);
    }
}
