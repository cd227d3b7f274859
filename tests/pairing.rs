//! Common random numbers: what one choice must leave alone.

use usar_sim::model::{Layout, RobotStart};

use crate::support::{SAMPLED, paper, paper_with, trial};

#[test]
fn the_policy_leaves_initial_levels_alone() {
    let short = paper_with(&[("duration_s: 600.0", "duration_s: 2.0")]);
    let levels = |policy| -> Vec<(u32, f64, f64)> {
        let record = trial(&short, policy, 9);
        record.robots.iter().map(|robot| (robot.robot, robot.initial_energy, robot.initial_hp)).collect()
    };
    let rne = levels("RNE");
    for policy in ["DIS", "ENG", "HP_DIS", "RANDOM"] {
        assert_eq!(levels(policy), rne, "{policy}");
    }
}

#[test]
fn one_more_robot_leaves_the_others_levels_and_the_layout_alone() {
    let as_it_is = paper_with(&SAMPLED);
    let one_more = paper_with(&[
        SAMPLED[0],
        SAMPLED[1],
        (
            "center: (46.4, 18.2), width_m: 1.0),",
            "center: (46.4, 18.2), width_m: 1.0),\n(role: \"carrier\", count: 1, center: (30.0, 20.0), \
             width_m: 0.0),",
        ),
    ]);
    let (before, after) = (Layout::sample(&as_it_is, 5).unwrap(), Layout::sample(&one_more, 5).unwrap());
    assert_eq!(after.robots.len(), 13);
    assert_eq!(before.robots[..], after.robots[..12]);
    assert_eq!((before.debris, before.zones), (after.debris, after.zones));
}

#[test]
fn initial_levels_follow_their_distributions() {
    let scenario = paper();
    let starts: Vec<_> = (0..500).flat_map(|seed| Layout::sample(&scenario, seed).unwrap().robots).collect();
    let mean = |level: fn(&RobotStart) -> f64| starts.iter().map(level).sum::<f64>() / starts.len() as f64;
    // Clamping N(80, 20) at 100 takes 1.67 off its mean, clamping N(90, 10) takes 0.83 (numerical
    // integration).
    assert!((mean(|start| start.energy) - 78.33).abs() < 0.8, "{}", mean(|start| start.energy));
    assert!((mean(|start| start.hp) - 89.17).abs() < 0.4, "{}", mean(|start| start.hp));
    assert!(
        starts.iter().all(|start| (1.0..=100.0).contains(&start.energy) && (1.0..=100.0).contains(&start.hp))
    );
}
