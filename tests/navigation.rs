//! The benchmark of right of way: its files are what its generators write, and its trials are measured.

use std::collections::BTreeSet;

use usar_sim::scenario::Scenario;
use xtask::navigation::problems::PROBLEMS;
use xtask::navigation::{FILE_SEED, folder, trial};

#[test]
fn the_files_are_what_the_generators_write() {
    for problem in &PROBLEMS {
        let path = folder().join(format!("{}.ron", problem.name));
        let text =
            std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        assert_eq!(text, problem.text(FILE_SEED), "{}: run `just navigation --write`", path.display());
    }
    let name = |entry: std::io::Result<std::fs::DirEntry>| entry.unwrap().file_name().into_string().unwrap();
    let files: BTreeSet<String> = std::fs::read_dir(folder()).unwrap().map(name).collect();
    let expected: BTreeSet<String> = PROBLEMS.iter().map(|problem| format!("{}.ron", problem.name)).collect();
    assert_eq!(files, expected);
}

#[test]
fn every_seed_gives_a_world_of_its_own() {
    for problem in &PROBLEMS {
        let texts: BTreeSet<String> = (1..=20).map(|seed| problem.text(seed)).collect();
        assert_eq!(texts.len(), 20, "{}", problem.name);
        for text in &texts {
            Scenario::parse(text, problem.name.as_ref()).unwrap_or_else(|error| panic!("{error}"));
        }
    }
}

#[test]
fn a_few_robots_arrive_with_little_delay() {
    for name in ["circle_2", "crossing_4", "doorway_2"] {
        let problem = PROBLEMS.iter().find(|problem| problem.name == name).unwrap();
        let outcome = trial::run(problem, FILE_SEED, &[]).unwrap();
        assert_eq!(outcome.robots, outcome.arrived, "{name}");
        assert!((0.99..2.0).contains(&outcome.flow), "{name}: {}", outcome.flow);
        assert!(outcome.time_s < outcome.limit_s, "{name}");
    }
}
