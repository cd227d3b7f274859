//! A program with a policy of its own runs it in sweeps and trials like the built-in ones.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use experiments::experiment::{Experiment, Overrides};
use experiments::run::Sessions;
use rne_core::{Decision, Policy, PolicyError, PolicyKind, Question};

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
