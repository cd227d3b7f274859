//! One seed, one result, bit for bit: the promises of `docs/determinism.md` that one process can test. Those about processes, threads and
//! surroundings are tested at the command line.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use experiments::experiment::{Experiment, Overrides};
use experiments::sweep::{Limits, Run, TrialKey, run_all};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rne_core::{GroupingPolicy, policy_named};
use usar_sim::record::TrialRecord;
use usar_sim::scenario::Scenario;
use usar_sim::simulation::Simulation;

use crate::golden;
use crate::support::{self, paper, paper_with};

/// Runs a trial and restores it from its own snapshot wherever `when` says so.
fn restored(
    scenario: &Scenario,
    policy: &dyn GroupingPolicy,
    mut when: impl FnMut(u64) -> bool,
) -> TrialRecord {
    let mut trial = Simulation::new(scenario, policy, 1).unwrap();
    while trial.ending().is_none() {
        trial.step().unwrap();
        if when(trial.steps()) {
            trial = Simulation::restore(scenario, policy, &trial.snapshot()).unwrap();
        }
    }
    trial.finish()
}

#[test]
fn a_trial_restored_at_every_step_of_1200_ends_as_if_it_had_not_been() {
    let scenario = paper_with(&[("duration_s: 600.0", "duration_s: 24.0")]);
    let policy = policy_named("RNE", &scenario.rne).unwrap();
    let whole = restored(&scenario, &*policy, |_| false);
    let pieces = restored(&scenario, &*policy, |_| true);
    assert_eq!(whole.chain.links().len(), 24);
    assert_eq!(whole, pieces);
}

#[test]
fn a_trial_restored_at_random_steps_ends_as_if_it_had_not_been() {
    let scenario = paper();
    for (seed, name) in ["RANDOM", "RNE"].into_iter().enumerate() {
        let policy = policy_named(name, &scenario.rne).unwrap();
        let mut draws = ChaCha8Rng::seed_from_u64(seed as u64);
        let whole = restored(&scenario, &*policy, |_| false);
        let pieces = restored(&scenario, &*policy, |_| draws.random_range(0..1000_u32) == 0);
        assert_eq!(whole, pieces, "{name}");
    }
}

#[test]
fn checking_and_listening_change_nothing() {
    let scenario = paper_with(&[("duration_s: 600.0", "duration_s: 60.0")]);
    let policy = policy_named("ENG", &scenario.rne).unwrap();
    let trial = || Simulation::new(&scenario, &*policy, 3).unwrap();
    let mut heard = 0;
    let plain = trial().run(|_, _, _| {});
    let listened = trial().run(|_, events, _| heard += events.len());
    let checked = trial().checked().run(|_, _, _| {});
    assert!(heard > 0);
    assert_eq!(plain.chain, listened.chain);
    assert_eq!(plain.chain, checked.chain);
}

#[test]
fn the_order_of_trials_changes_nothing() {
    let overrides =
        Overrides { trials: Some(2), set: vec!["duration_s=30.0".to_owned()], ..Overrides::default() };
    let experiment =
        Arc::new(Experiment::load(&support::root().join("scenarios/paper.ron"), &overrides).unwrap());
    let forwards: Vec<TrialKey> = experiment.keys(None).collect();
    let mut shuffled = forwards.clone();
    shuffled.reverse();
    shuffled.swap(1, 5);
    let records = |keys: &[TrialKey]| {
        let experiment = Arc::clone(&experiment);
        let run: Arc<Run> = Arc::new(move |key, halt| experiment.run(key, halt));
        let limits = Limits { jobs: 2, trial: None };
        let mut outcomes = Vec::new();
        let all = run_all(keys.to_vec(), limits, run, &AtomicBool::new(false), |outcome| {
            outcomes.push(outcome);
            Ok(())
        });
        assert!(all.unwrap());
        outcomes.sort_by(|a, b| a.key.cmp(&b.key));
        outcomes.into_iter().map(|outcome| outcome.result.unwrap().record).collect::<Vec<_>>()
    };
    assert_eq!(records(&forwards), records(&shuffled));
}

/// Renewed by `just golden` only, with a line in the changelog. CI compares the same file with a release build.
#[test]
fn the_small_worlds_have_their_golden_hashes() {
    let expected = std::fs::read_to_string(golden::path()).unwrap();
    assert_eq!(golden::hashes(), expected, "numbers changed: see docs/determinism.md");
}
