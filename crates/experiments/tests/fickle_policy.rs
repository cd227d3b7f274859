//! A policy that is not a function of its question, and a policy that panics. Both are reported as such.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use experiments::experiment::{Experiment, Overrides};
use experiments::note_panic;
use experiments::run::{Limits, Sessions, run_all};
use teaming::{Decision, Policy, PolicyError, PolicyKind, Question};

static ASKED: AtomicU64 = AtomicU64::new(0);

/// Sends all robots to one task, then to the other.
#[derive(Clone)]
struct Fickle;

impl Policy for Fickle {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let mut groups = vec![Vec::new(); question.tasks.len()];
        let task = ASKED.fetch_add(1, Ordering::Relaxed) as usize % groups.len();
        groups[task] = question.members.iter().map(|member| member.id).collect();
        Ok(Decision::unscored(groups))
    }
}

#[derive(Clone)]
struct Panics;

impl Policy for Panics {
    fn decide(&self, _: &Question) -> Result<Decision, PolicyError> {
        panic!("no answer")
    }
}

#[test]
fn fickle_policies_and_panics_are_named() {
    let mut registry = policies::standard();
    registry.add(PolicyKind::plain("FICKLE", "now here, now there", Fickle)).unwrap();
    registry.add(PolicyKind::plain("PANICS", "never answers", Panics)).unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let policies = ["FICKLE", "DIS", "PANICS"].map(str::to_owned).to_vec();
    let overrides = Overrides {
        policies: Some(policies),
        trials: Some(1),
        set: vec!["duration_s=60.0".to_owned(), "mission.group_sizes=Free".to_owned()],
        ..Overrides::default()
    };
    let experiment =
        Arc::new(Experiment::load(&root.join("scenarios/paper.ron"), &overrides, &registry).unwrap());
    let halt = AtomicBool::new(false);
    let otherwise = |policy: usize| {
        let key = experiment.key((0, policy, 1));
        let record = experiment.run_alone(&key, &mut Sessions::default(), &halt).unwrap().record;
        experiment.answers_otherwise(&key, &record)
    };
    assert_eq!([otherwise(0), otherwise(1)], [Some(1), None]);

    std::panic::set_hook(Box::new(note_panic));
    let shared = Arc::clone(&experiment);
    let run = Arc::new(move |key: &_, sessions: &mut _, halt: &_| shared.run_alone(key, sessions, halt));
    let mut reasons = Vec::new();
    let keys = vec![experiment.key((0, 2, 1))];
    run_all(keys, Limits { jobs: 1, trial: None }, run, &halt, |outcome| {
        reasons.extend(outcome.failure());
        Ok(())
    })
    .unwrap();
    assert!(
        reasons[0].contains("internal error: no answer (crates/experiments/tests/fickle_policy.rs:"),
        "{reasons:?}"
    );
}
