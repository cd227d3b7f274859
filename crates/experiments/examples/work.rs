//! Fixed pieces of work, to count their instructions: `just instructions`.
//!
//! `cargo run --release --example work -- trial|grouping`

#[path = "../../usar-sim/benches/team.rs"]
mod team;

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rne_core::{RneOptions, policy_named};
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
    let policy = policy_named("RNE", &scenario.rne).expect("known");
    let mut trial = Simulation::new(&scenario, &*policy, 1).expect("drawn");
    (0..STEPS).for_each(|_| trial.step().expect("sound"));
    println!("{}", trial.finish().state_hash);
}

/// The search for the best split of 20 robots of one role, the largest that is exact, and by local search of 60.
fn grouping() {
    let policy = policy_named("RNE", &RneOptions::default()).expect("known");
    for carriers in [20, 60] {
        let grouping = policy.group(&team::team([carriers, 0, 0]), &mut ChaCha8Rng::seed_from_u64(1));
        println!("{:?}", grouping.expect("a grouping"));
    }
}
