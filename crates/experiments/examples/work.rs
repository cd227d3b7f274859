//! Fixed pieces of work, to count their instructions: `just instructions`.
//!
//! `cargo run --release --example work -- trial|grouping`

#[path = "../../usar-sim/benches/team.rs"]
mod team;

use std::sync::Arc;

use rne_core::{Policy, Registry};
use usar_sim::scenario::Scenario;
use usar_sim::simulation::Simulation;

/// Half a minute of the paper's mission.
const STEPS: u32 = 1_500;

fn main() {
    match std::env::args().nth(1).as_deref() {
        Some("trial") => trial(),
        Some("grouping") => grouping(),
        _ => panic!("say which: trial or grouping"),
    }
}

fn trial() {
    let (scenario, _) = Scenario::load("scenarios/paper.ron".as_ref()).expect("run from the project's root");
    let rne = rne();
    let mut trial = Simulation::new(&scenario, 1).expect("drawn");
    (0..STEPS).for_each(|_| assert_eq!(trial.step(&*rne), None));
    println!("{}", trial.finish().state_hash);
}

fn rne() -> Arc<dyn Policy> {
    Registry::standard().parse("RNE").expect("known").policy
}

/// The search for the best split of 20 robots of one role, the largest that is exact, and by local search of 60.
fn grouping() {
    let rne = rne();
    for carriers in [20, 60] {
        let decision = rne.decide(&team::question([carriers, 0, 0]));
        println!("{:?}", decision.expect("a decision").assignment);
    }
}
