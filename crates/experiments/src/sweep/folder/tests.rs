use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::{Folder, Opening};
use crate::experiment::{Experiment, Overrides, Parts};
use crate::run::Limits;
use crate::sweep::{missing, run_trials};

/// Two short trials of each of these policies.
fn experiment(policies: &[&str]) -> Experiment {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    let paper = manifest.ancestors().nth(2).unwrap().join("scenarios/paper.ron");
    let overrides = Overrides {
        policies: Some(policies.iter().map(|&policy| policy.to_owned()).collect()),
        trials: Some(2),
        set: vec!["duration_s=20.0".to_owned()],
        ..Overrides::default()
    };
    Experiment::load(&paper, &overrides, &policies::standard()).unwrap()
}

/// The same experiment by a program in which the policy with this number had other sources.
fn before_an_edit(experiment: Experiment, policy: usize) -> Experiment {
    let mut program = experiment.program.clone();
    program.policies[policy] = "before the edit".to_owned();
    Experiment::assemble(Parts {
        registry: policies::standard(),
        policies: experiment.policies.iter().map(|policy| policy.written().to_owned()).collect(),
        name: experiment.name,
        given: experiment.given,
        base: experiment.base,
        axes: experiment.axes,
        trials: experiment.trials,
        seeds: experiment.seeds,
        is_checked: experiment.is_checked,
        keep: experiment.keep,
        plan: experiment.plan,
        program: Some(program),
    })
    .unwrap()
}

/// Opens the folder, runs what is missing, and finishes it. Returns what was said, and the number of trials.
fn sweep(path: &Path, experiment: Experiment) -> (Vec<String>, usize) {
    let mut said = Vec::new();
    let mut folder =
        Folder::open(path, Arc::new(experiment), Opening::default(), &mut |line| said.push(line)).unwrap();
    let (missing, stop) = (missing(&folder, None), AtomicBool::new(false));
    let count = missing.len();
    let limits = Limits { jobs: 1, trial: None };
    run_trials(&mut folder, missing, limits, &stop, |_| {}).unwrap();
    folder.finish(&stop).unwrap();
    (said, count)
}

/// The names and contents of a folder's files, except the account of the runs.
fn contents(path: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let names = std::fs::read_dir(path).unwrap().map(|entry| entry.unwrap().file_name());
    let mut names: Vec<PathBuf> = names.map(PathBuf::from).filter(|name| name != "host.json").collect();
    names.sort();
    names.into_iter().map(|name| (name.clone(), std::fs::read(path.join(name)).unwrap())).collect()
}

#[test]
fn an_edited_policy_and_an_added_one_keep_the_trials_of_the_others() {
    let folder = tempfile::tempdir().unwrap();
    let [grown, fresh] = ["grown", "fresh"].map(|name| folder.path().join(name));
    let (said, ran) = sweep(&grown, before_an_edit(experiment(&["DIS", "ENG"]), 0));
    assert_eq!((said.len(), ran), (0, 4));

    let (said, ran) = sweep(&grown, experiment(&["DIS", "ENG", "RANDOM"]));
    let [said] = &said[..] else { panic!("{said:?}") };
    assert!(said.ends_with("policy DIS has changed since; its trials are run again: 2"), "{said}");
    assert_eq!(ran, 4, "two of the edited policy and two of the new one");

    sweep(&fresh, experiment(&["DIS", "ENG", "RANDOM"]));
    assert_eq!(contents(&grown), contents(&fresh));
    assert_eq!(sweep(&grown, experiment(&["DIS", "ENG", "RANDOM"])), (vec![], 0));
}

#[test]
fn a_folder_that_has_more_policies_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    sweep(folder.path(), experiment(&["DIS", "ENG"]));
    let again = Folder::open(folder.path(), Arc::new(experiment(&["ENG"])), Opening::default(), &mut |_| {});
    let reason = again.err().unwrap().to_string();
    assert!(reason.contains("policies: DIS, ENG there, ENG now"), "{reason}");
}
