//! A program with a policy of its own runs it in sweeps and trials like the built-in ones.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use experiments::comparison::{Choice, compare};
use experiments::experiment::{Experiment, Overrides};
use experiments::rounds::odd_sizes;
use experiments::run::{Limits, Sessions};
use experiments::sweep::folder::{Folder, Opening};
use experiments::sweep::{missing, run_trials};
use serde::{Deserialize, Serialize};
use teaming::{Decision, Policy, PolicyError, PolicyKind, Question};

/// Sends all robots to the easiest task.
#[derive(Clone)]
struct Lazy;

impl Policy for Lazy {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let mut groups = vec![Vec::new(); question.tasks.len()];
        if let Some(easiest) = question.hardest_first().last() {
            groups[easiest.index()] = question.members.iter().map(|member| member.id).collect();
        }
        Ok(Decision::unscored(groups))
    }
}

#[test]
fn a_policy_of_another_crate_is_swept_beside_the_built_in_ones() {
    let mut registry = policies::standard();
    registry.add(PolicyKind::plain("LAZY", "everybody goes to the easiest task", Lazy)).unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let overrides = Overrides {
        policies: Some(vec!["LAZY".to_owned(), "DIS".to_owned()]),
        trials: Some(1),
        set: vec!["duration_s=200.0".to_owned(), "mission.group_sizes=Free".to_owned()],
        ..Overrides::default()
    };
    let experiment = Experiment::load(&root.join("scenarios/paper.ron"), &overrides, &registry).unwrap();
    experiment.check_start("paper.ron".as_ref()).unwrap();
    let halt = AtomicBool::new(false);
    let rescued = |policy: usize| {
        let record =
            experiment.run(&experiment.key((0, policy, 1)), &mut Sessions::default(), &halt).unwrap().record;
        ["hard", "easy"].map(|task| record.task(task).unwrap().rescued)
    };
    let [lazy, dis] = [rescued(0), rescued(1)];
    assert!(lazy[0] == 0 && lazy[1] > 0 && dis[0] > 0, "{lazy:?} {dis:?}");
}

/// A policy with options.
#[derive(Clone, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Options {
    gain: f64,
    is_quick: bool,
}

#[test]
fn a_folder_with_a_policy_of_ones_own_can_be_read_by_a_program_without_it() {
    let mut registry = policies::standard();
    registry.add(PolicyKind::plain("LAZY", "everybody goes to the easiest task", Lazy)).unwrap();
    let eager = |_: Options| Ok::<_, PolicyError>(Lazy);
    registry.add(PolicyKind::with_options("EAGER", "like LAZY", eager)).unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let policies = ["LAZY", "quick=EAGER(is_quick: true)", "EAGER(gain: 2.0)", "DIS"];
    let overrides = Overrides {
        policies: Some(policies.map(str::to_owned).to_vec()),
        trials: Some(2),
        set: vec!["duration_s=30.0".to_owned(), "mission.group_sizes=Free".to_owned()],
        ..Overrides::default()
    };
    let experiment =
        Arc::new(Experiment::load(&root.join("scenarios/paper.ron"), &overrides, &registry).unwrap());
    let out = tempfile::tempdir().unwrap();
    let path = out.path().join("own");
    let halt = AtomicBool::new(false);
    let mut folder = Folder::open(&path, Arc::clone(&experiment), Opening::default(), &mut |_| {}).unwrap();
    let left = missing(&folder, None);
    run_trials(&mut folder, left, Limits { jobs: 2, trial: None }, &halt, |_| {}).unwrap();
    folder.finish(&halt).unwrap();
    drop(folder);

    let mut stranger = Folder::read(&path, &policies::standard()).unwrap();
    let odd: Vec<String> = odd_sizes(&mut stranger).unwrap().iter().map(ToString::to_string).collect();
    assert_eq!(odd.len(), 3, "all but DIS: {odd:?}");
    let says = "LAZY does not keep the sizes that groups should have in 2 of 2 trials, which \
                `mission.group_sizes: Free` allows (first in trial 1, round 1: role \"carrier\" must be \
                split into parts of [3, 3] members, found [0, 6])";
    assert!(odd[0].starts_with(says), "{odd:?}");
    let of_stranger = stranger.experiment();
    for key in experiment.keys(None) {
        let place = (key.case, key.policy, key.trial);
        assert_eq!(of_stranger.id(&of_stranger.key(place)), experiment.id(&key), "{}", key.label);
        assert!(stranger.value(place, 0).is_some(), "{}", key.label);
    }
    let compared = compare(&stranger, &[0], Choice::default()).unwrap();
    assert_eq!((compared.len(), compared[0].n), (6, 2));
    let run =
        |policy| of_stranger.run_alone(&of_stranger.key((0, policy, 1)), &mut Sessions::default(), &halt);
    assert!(run(3).is_ok());
    let refused = run(1).err().unwrap().reason;
    assert!(refused.contains("does not have the policy EAGER"), "{refused}");
}
