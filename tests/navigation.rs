//! The benchmark of right of way: its scenarios are those of its problems, and its trials are measured.

use std::collections::BTreeSet;

use scenario::Scenario;
use xtask::navigation::problems::problems;
use xtask::navigation::{FILE_SEED, folder, trial};

#[test]
fn the_scenarios_are_the_first_seeds_of_the_problems() {
    for problem in problems() {
        let path = folder().join(format!("{}.ron", problem.name));
        let text =
            std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        assert_eq!(text, problem.text(FILE_SEED), "{}: run `just navigation --write`", path.display());
    }
    let name = |entry: std::io::Result<std::fs::DirEntry>| entry.unwrap().file_name().into_string().unwrap();
    let files: BTreeSet<String> = std::fs::read_dir(folder()).unwrap().map(name).collect();
    let expected: BTreeSet<String> =
        problems().iter().map(|problem| format!("{}.ron", problem.name)).collect();
    assert_eq!(files, expected);
}

#[test]
fn every_seed_gives_a_world_of_its_own() {
    for problem in problems() {
        let texts: BTreeSet<String> = (1..=20).map(|seed| problem.text(seed)).collect();
        assert_eq!(texts.len(), 20, "{}", problem.name);
        for text in &texts {
            Scenario::parse(text, problem.name.as_str().as_ref()).unwrap_or_else(|error| panic!("{error}"));
        }
    }
}

#[test]
fn a_few_robots_arrive_with_little_delay() {
    for name in ["circle_2", "crossing_4", "doorway_2"] {
        let outcome = outcome(name, FILE_SEED);
        assert_eq!(outcome.robots, outcome.arrived, "{name}");
        assert!((0.99..2.0).contains(&outcome.flow), "{name}: {}", outcome.flow);
        assert!(outcome.time_s < outcome.limit_s, "{name}");
    }
}

fn outcome(name: &str, seed: u64) -> trial::Outcome {
    let problem = problems().into_iter().find(|problem| problem.name == name).unwrap();
    trial::run(&problem, seed, &[]).unwrap()
}

#[test]
fn robots_queue_before_a_bottleneck_and_do_not_touch() {
    let outcome = outcome("bottleneck_10", FILE_SEED);
    assert!(outcome.is_ok() && outcome.flow < 1.4, "{}", outcome.flow);
    assert!(outcome.touches < 0.01, "{}", outcome.touches);
}

#[test]
fn robots_enter_a_crossing_that_others_have_left_behind() {
    let outcome = outcome("lane_crossing_8", FILE_SEED);
    assert!(outcome.is_ok() && outcome.flow < 2.0, "{}", outcome.flow);
}

/// In this trial, a robot in a corner is asked to make room by the very robot that is in its way.
#[test]
fn a_robot_in_a_corner_is_let_out() {
    assert!(outcome("swap_42", 19).is_ok());
}
