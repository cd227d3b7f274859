//! Nothing appears or vanishes: rescuees, capacity, resources, energy and HP, checked at every event; and nothing teleports.

use rne_core::policy_named;
use usar_sim::scenario::Scenario;
use usar_sim::simulation::Simulation;

use crate::ledger::Ledger;
use crate::support::{paper, paper_with};

fn check_trial(scenario: &Scenario, policy: &str, seed: u64) -> Ledger {
    let policy = policy_named(policy, &scenario.rne).unwrap();
    let simulation = Simulation::new(scenario, &*policy, seed).unwrap();
    let mut ledger = Ledger::of(simulation.world());
    let record = simulation.run(|_, events, world| {
        ledger.hear(events, world, scenario.dt_s as f32);
    });
    assert_eq!(record.rescued() as usize, ledger.delivered.len());
    assert_eq!(
        (record.hard.secured + record.easy.secured) as usize,
        ledger.delivered.len() + ledger.on_board.len()
    );
    let spent: f64 = record.robots.iter().map(|robot| robot.energy_spent).sum();
    let lost: f64 = record.robots.iter().map(|robot| robot.hp_lost).sum();
    assert!((record.energy() - spent).abs() < 1e-6 && (record.hp() - lost).abs() < 1e-6);
    ledger
}

#[test]
fn rescuees_capacity_resources_and_levels_are_conserved_at_every_event() {
    assert!(check_trial(&paper(), "RNE", 1).events > 500);
}

#[test]
fn they_are_conserved_when_energy_and_health_bind_and_robots_are_lost() {
    let harsh = paper_with(&[
        ("per_step: 0.0045", "per_step: 0.02"),
        ("per_step: 0.0003", "per_step: 0.02"),
        ("energy_turn_back: AtOnce", "energy_turn_back: WhenHome"),
        ("rest_reserve: 1.5", "rest_reserve: 0.0"),
    ]);
    assert!(check_trial(&harsh, "RANDOM", 2).lost > 0, "robots are lost");
}
