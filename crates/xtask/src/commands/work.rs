//! Fixed workloads whose instructions are counted: `just instructions`.
//!
//! `work trial|grouping`

use std::process::ExitCode;
use std::sync::Arc;

use rne_core::Policy;
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
    let rne = rne();
    let mut trial = Simulation::new(&scenario, 1).expect("drawn");
    (0..STEPS).for_each(|_| assert_eq!(trial.step(&*rne), None));
    println!("{}", trial.finish().state_hash);
}

fn rne() -> Arc<dyn Policy> {
    policies::standard().parse("RNE").expect("known").policy
}

/// Searches for the best split of a role: 20 robots, the largest number that is exact, and 60 robots by
/// local search.
fn grouping() {
    let rne = rne();
    for carriers in [20, 60] {
        let decision = rne.decide(&team::question([carriers, 0, 0]));
        println!("{:?}", decision.expect("a decision").assignment);
    }
}
