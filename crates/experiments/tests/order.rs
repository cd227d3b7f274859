//! The order in which a sweep runs its trials.

use std::path::Path;
use std::sync::Arc;

use experiments::experiment::{Experiment, Overrides};
use experiments::sweep::folder::{Folder, Opening};
use experiments::sweep::missing;

#[test]
fn an_interrupted_sweep_has_the_first_seeds_of_every_case() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let overrides = Overrides {
        policies: Some(vec!["RNE".to_owned(), "DIS".to_owned()]),
        trials: Some(20),
        ..Overrides::default()
    };
    let experiment =
        Experiment::load(&root.join("scenarios/sweeps/energy.ron"), &overrides, &policies::standard())
            .unwrap();
    let cases = experiment.cases.len();
    assert!(cases > 1);
    let place = tempfile::tempdir().unwrap();
    let opening = Opening::default();
    let folder =
        Folder::open(&place.path().join("energy"), Arc::new(experiment), opening, &mut |_| ()).unwrap();
    let missing = missing(&folder, None);
    assert_eq!(missing.len(), cases * 2 * 20);
    // Eight seeds of both policies in each case, then eight more.
    for (i, part) in missing.chunks(16).take(cases).enumerate() {
        assert!(part.iter().all(|(case, _, trial)| *case == i && *trial <= 8), "{part:?}");
        let policies: Vec<usize> = part.iter().map(|(_, policy, _)| *policy).collect();
        assert_eq!(policies, [[0; 8], [1; 8]].concat(), "policy by policy");
    }
    let mut all = missing.clone();
    all.sort_unstable();
    all.dedup();
    assert_eq!(all.len(), missing.len(), "each trial once");
}
