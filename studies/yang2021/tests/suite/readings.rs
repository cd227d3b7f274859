//! The readings of a sweep and their effects.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use experiments::experiment::{Experiment, Overrides};
use experiments::run::Limits;
use experiments::sweep::folder::{Folder, Opening};
use experiments::sweep::{missing, run_trials};
use statrs::distribution::{ContinuousCDF, StudentsT};
use yang2021::readings::{Trials, rivals};

/// `rivals` counts by intervals. Here the counts are computed again from the differences.
#[test]
fn readings_are_counted_against_each_rival_and_against_all() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let scenario = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/paper-calibrated.ron");
    std::fs::copy(scenario, folder.join("paper.ron")).unwrap();
    let text = "(name: \"r\", scenario: \"paper.ron\", set: {\"duration_s\": 300.0}, policies: \
        [\"RNE\", \"DIS\", \"HP_DIS\"],
        readings: {\"hard_rule\": [IntraGroupTrust, MeanHp], \"merge\": [Apart, Together]}, trials: 8, keep: \
        Rounds)";
    std::fs::write(folder.join("r.ron"), text).unwrap();
    let experiment =
        Experiment::load(&folder.join("r.ron"), &Overrides::default(), &policies::standard()).unwrap();
    let mut ignore = |_| ();
    let mut sweep =
        Folder::open(&folder.join("out"), Arc::new(experiment), Opening::default(), &mut ignore).unwrap();
    let (all, limits) = (missing(&sweep, None), Limits { jobs: 2, trial: None });
    run_trials(&mut sweep, all, limits, &AtomicBool::new(false), |_| ()).unwrap();
    let rows = rivals(&Trials::of(&sweep), &[0, 1, 2, 3]);
    let sides = |metric: &str, rival: usize, tail: f64| -> Vec<i32> {
        let metric = sweep.experiment().metrics.named(metric).unwrap();
        let value = |policy: usize, trial: u32| sweep.value((0, policy, trial), metric).unwrap();
        let t = StudentsT::new(0.0, 1.0, 7.0).unwrap().inverse_cdf(1.0 - tail);
        let side = |reading: usize| {
            let differences: Vec<f64> =
                (1..=8).map(|trial| value(reading, trial) - value(rival, trial)).collect();
            let mean = differences.iter().sum::<f64>() / 8.0;
            let variance = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / 7.0;
            let half = t * (variance / 8.0).sqrt();
            i32::from(mean - half > 0.0) - i32::from(mean + half < 0.0)
        };
        (0..4).map(side).collect()
    };
    let count = |sides: &[i32], side: i32| sides.iter().filter(|found| **found == side).count();
    let mut decided = 0;
    for row in &rows {
        let both = |tail: f64| [4, 5].map(|rival| sides(&row.metric, rival, tail));
        let [own, shared] = [0.025, 0.025 / 4.0].map(|tail| match row.rival.as_deref() {
            Some("DIS") => both(tail)[0].clone(),
            Some(_) => both(tail)[1].clone(),
            None => {
                both(tail)[0].iter().zip(&both(tail)[1]).map(|(a, b)| if a == b { *a } else { 0 }).collect()
            }
        });
        assert_eq!(row.counts, [1, -1, 0].map(|side| count(&own, side)), "{} {:?}", row.metric, row.rival);
        assert_eq!(row.corrected, [1, -1].map(|side| count(&shared, side)), "{} {:?}", row.metric, row.rival);
        decided += row.counts[0] + row.counts[1];
    }
    assert_eq!(rows.len(), 4 * 3);
    assert!(decided > 0, "nothing to count");
}
