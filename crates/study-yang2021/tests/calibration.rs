//! The calibration that made `paper-calibrated.ron`, and the log of a calibration.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use experiments::explore::Parameter;
use ron_tree::Node;
use study_yang2021::calibration::{Calibration, Log, Spread, Target, the_policy};
use usar_sim::scenario::Scenario;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap().to_owned()
}

/// The log of the chosen calibration is in `docs/calibration/`. Its best candidate is the scenario: the
/// values are the same, and the same trials have the same outcome, bit for bit.
#[test]
fn the_calibrated_scenario_is_the_best_of_its_log() {
    let (scenario, text) = Scenario::load(&root().join("scenarios/paper-calibrated.ron")).unwrap();
    let fields = Node::parse(&text).unwrap();
    let log = std::fs::read_to_string(root().join("docs/calibration/chosen.csv")).unwrap();
    let mut rows = csv::Reader::from_reader(log.as_bytes());
    let header = rows.headers().unwrap().clone();
    let records: Vec<csv::StringRecord> = rows.records().map(Result::unwrap).collect();
    let misfit = |record: &csv::StringRecord| record[1].parse::<f64>().unwrap();
    let best = records.iter().min_by(|a, b| misfit(a).total_cmp(&misfit(b))).unwrap();
    let names = || header.iter().zip(best).filter(|(name, _)| name.contains('.'));
    assert!(names().count() >= 5, "{header:?}");
    for (name, value) in names() {
        let path = name.replace("[*]", "[0]");
        let written = fields.get(&path).unwrap().as_word().unwrap().parse::<f64>().unwrap();
        assert_eq!(written.to_bits(), value.parse::<f64>().unwrap().to_bits(), "{path}");
    }
    let target = Target::load(&root().join("scenarios/reference/dis_trials.csv"), &scenario).unwrap();
    let calibration = Calibration {
        text,
        base: scenario,
        policy: the_policy(&policies::standard()).unwrap(),
        free: Vec::new(),
        target,
        trials: 10,
        first_seed: 100_001,
        first_step: 0.25,
    };
    let found = calibration.measure(&[], (100_001..100_011_u64).collect::<Vec<_>>(), &AtomicBool::new(false));
    let spreads: Vec<Spread> =
        found.unwrap().unwrap().iter().filter_map(|values| Spread::of(values)).collect();
    let cell =
        |name: String| best[header.iter().position(|known| known == name).unwrap()].parse::<f64>().unwrap();
    for (quantity, spread) in calibration.target.quantities.iter().zip(&spreads) {
        let logged = ["mean", "sd"].map(|kind| cell(format!("{}_{kind}", quantity.name)).to_bits());
        assert_eq!([spread.mean, spread.sd].map(f64::to_bits), logged, "{}", quantity.name);
    }
    let edges = misfit(best) - calibration.target.misfit(&spreads, 10);
    assert!((0.0..4.0).contains(&edges), "what values near the ends of their ranges add: {edges}");
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
    let held = Log::open(&out, &calibration, false).unwrap();
    let error = Log::open(&out, &calibration, false).err().unwrap();
    assert!(error.to_string().contains("another process is at work"), "{error}");
    drop(held);
    assert!(Log::open(&out, &calibration, false).is_ok());
}
