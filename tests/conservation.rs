//! Nothing appears or vanishes: rescuees, capacity, resources, energy and HP, with every invariant checked at
//! every step.

use scenario::Scenario;
use usar_sim::record::{Status, TrialRecord};

use crate::support::{paper, paper_with, root, trial};

fn check_trial(scenario: &Scenario, policy: &str, seed: u64) -> TrialRecord {
    let record = trial(scenario, policy, seed);
    assert!(!matches!(record.status, Status::Failed(_)), "{:?}", record.status);
    let spent: f64 = record.robots.iter().map(|robot| robot.energy_spent).sum();
    let lost: f64 = record.robots.iter().map(|robot| robot.hp_lost).sum();
    assert!((record.energy() - spent).abs() < 1e-6 && (record.hp() - lost).abs() < 1e-6);
    assert!(record.tasks.iter().all(|task| task.totals.rescued <= task.totals.secured));
    record
}

#[test]
fn rescuees_capacity_resources_and_levels_are_conserved() {
    assert!(check_trial(&paper(), "RNE", 1).rescued() > 100);
}

#[test]
fn they_are_conserved_when_energy_and_health_bind_and_robots_are_lost() {
    let harsh = paper_with(&[
        ("per_step: 0.0045", "per_step: 0.02"),
        ("per_step: 0.0003", "per_step: 0.02"),
        ("energy_turn_back: AtOnce", "energy_turn_back: WhenHome"),
        ("rest_reserve: 1.5", "rest_reserve: 0.0"),
    ]);
    let record = check_trial(&harsh, "RANDOM", 2);
    assert!(record.stranded() + record.disabled() > 0, "robots are lost");
}

#[test]
fn what_events_take_from_robots_is_charged_to_the_trial_too() {
    let (failures, _) = Scenario::load(&root().join("scenarios/gallery/failures.ron")).unwrap();
    let record = check_trial(&failures, "DIS", 1);
    assert!(record.hp() > 50.0, "three robots failed and one was hurt: {} HP", record.hp());
    assert!((record.energy() - 454.96).abs() < 0.01, "60 of it by an event: {}", record.energy());
}
