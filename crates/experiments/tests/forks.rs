//! A trial that continues from a checkpoint equals the uninterrupted trial.

use std::path::Path;

use experiments::experiment::with_settings;
use experiments::oracle::{Branch, advance_to};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use scenario::Scenario;
use teaming::{Asked, Deadline};
use usar_sim::simulation::Simulation;

const SCENARIOS: [&str; 6] =
    ["paper", "paper-calibrated", "three-tasks", "ground-only", "eight-needs", "two-aerial-roles"];

#[test]
fn a_fork_without_a_change_has_the_same_hash_for_20_drawn_trials() {
    let mut draws = ChaCha8Rng::seed_from_u64(20);
    let registry = policies::standard();
    let names = registry.names();
    for _ in 0..20 {
        let scenario = SCENARIOS[draws.random_range(0..SCENARIOS.len())];
        let (seed, round) = (draws.random_range(1..1_000_000_u64), draws.random_range(1..4_u32));
        let mut policy = registry.open(names[draws.random_range(0..names.len())]).unwrap();
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenarios/{scenario}.ron"));
        let (loaded, _) = Scenario::load(&path).unwrap();
        let short = with_settings(&loaded, &["duration_s=240".to_owned()]).unwrap();
        let whole = Simulation::new(&short, seed).unwrap().run(&mut *policy, |_, _, _| {});
        let mut trial = Simulation::new(&short, seed).unwrap();
        if advance_to(&mut trial, &mut *policy, round, Deadline::NEVER).is_err() {
            assert!(whole.decisions.len() < round as usize, "{scenario} {seed}: round {round} was there");
            continue;
        }
        let decision = policy.decide(&Asked::of(trial.question().unwrap())).unwrap();
        let mut branch = Branch::begin(&trial.checkpoint(), decision).unwrap();
        branch.to_round_end(Deadline::NEVER).unwrap();
        branch.to_trial_end(&mut *policy, Deadline::NEVER).unwrap();
        assert_eq!(branch.finish(), whole, "{scenario}, seed {seed}, round {round}");
    }
}
