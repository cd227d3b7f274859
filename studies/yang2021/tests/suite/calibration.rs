//! The calibration that made `paper-calibrated.ron`, and the log of a calibration.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use experiments::explore::Parameter;
use ron_tree::Node;
use scenario::Scenario;
use yang2021::calibration::{Calibration, Spread, Target, open, the_policy};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap().to_owned()
}

/// `studies/yang2021/docs/calibration/fits.csv` tells what the chosen candidate did in the trials that it was
/// fitted to: in the scenario of the repository the same trials have the same outcome, bit for bit.
#[test]
fn the_calibrated_scenario_is_the_choice() {
    let (scenario, text) = Scenario::load(&root().join("scenarios/paper-calibrated.ron")).unwrap();
    let target = Target::load(&root().join("scenarios/reference/dis_trials.csv"), &scenario).unwrap();
    let policy = the_policy(&policies::standard()).unwrap();
    let (base, free, trials, first_seed) = (scenario, Vec::new(), 10, 100_001);
    let calibration = Calibration { text, base, policy, free, target, trials, first_seed, first_step: 0.25 };
    let found = calibration.measure(&[], (100_001..100_011_u64).collect::<Vec<_>>(), &AtomicBool::new(false));
    let spreads: Vec<Spread> =
        found.unwrap().unwrap().iter().filter_map(|values| Spread::of(values)).collect();
    let fits = csv::Reader::from_path(root().join("studies/yang2021/docs/calibration/fits.csv")).unwrap();
    let rows: Vec<csv::StringRecord> = fits.into_records().map(Result::unwrap).collect();
    let chosen: Vec<_> = rows.iter().filter(|row| row[0] == rows[0][0]).collect();
    let quantities = &calibration.target.quantities;
    assert_eq!((quantities.len(), spreads.len(), chosen.len()), (7, 7, 7));
    for ((quantity, spread), row) in quantities.iter().zip(&spreads).zip(chosen) {
        let told = [4, 5].map(|cell| row[cell].parse::<f64>().unwrap().to_bits());
        assert_eq!(row[1], quantity.name);
        assert_eq!([spread.mean, spread.sd].map(f64::to_bits), told, "{}", quantity.name);
    }
}

#[test]
fn a_log_is_held_by_one_process() {
    let place = tempfile::tempdir().unwrap();
    let (base, text) = Scenario::load(&root().join("scenarios/paper.ron")).unwrap();
    let free = vec![
        Parameter::parse(
            "mission.loading_s=1..3",
            &Node::parse(&text).unwrap(),
            &Node::parse(&text).unwrap(),
        )
        .unwrap(),
    ];
    let table = place.path().join("target.csv");
    std::fs::write(&table, "method,rescuees_hard,energy_hard\nDIS,10,150\nDIS,14,160\nDIS,12,170\n").unwrap();
    let target = Target::load(&table, &base).unwrap();
    let (policy, trials, first_seed) = (the_policy(&policies::standard()).unwrap(), 2, 1);
    let calibration = Calibration { text, base, policy, free, target, trials, first_seed, first_step: 0.25 };
    let out = place.path().join("out");
    let held = open(&out, &calibration, false).unwrap();
    let error = open(&out, &calibration, false).err().unwrap();
    assert!(error.to_string().contains("another process is at work"), "{error}");
    drop(held);
    assert!(open(&out, &calibration, false).is_ok());
}
