//! `usar bench`: gaps of policies to the optimum of problems of task allocation.

use crate::commands::json;
use crate::place::refused;
use crate::support::{read, succeeds, usar};

/// The published problem `1p_000000` of MRTA-Benchmark; its least makespan is 570.16711.
const PUBLISHED: &str = r#"{"Q": [[0,0,1],[0,1,0],[1,0,0]],
    "R": [[0,0,0],[0,0,1],[1,0,1],[0,1,0],[0,0,1],[1,0,0],[0,0,1],[0,1,0],[1,1,0],[0,0,0]],
    "T_e": [0,93,95,68,89,70,89,61,62,0],
    "task_locations": [[34,17],[38,43],[4,70],[23,77],[96,13],[44,95],[13,11],[18,31],[12,8],[91,26]],
    "precedence_constraints": [[7,3]]}"#;

#[test]
fn a_published_problem_has_the_published_gap() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("1p_000000.json");
    std::fs::write(&path, PUBLISHED).unwrap();
    let found = json(&["bench", path.to_str().unwrap(), "--policies", "DIS", "--json"]);
    assert_eq!((&found["problems"], &found["exact"]), (&1.into(), &1.into()));
    let gap = found["rows"][0]["worst"].as_f64().unwrap();
    assert!((gap - 100.0 * (699.467_73 / 570.167_11 - 1.0)).abs() < 1e-4, "{found}");
}

#[test]
fn threads_change_no_byte_and_made_problems_can_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let run = |words: &str| succeeds(&usar(folder.path(), words));
    for jobs in ["1", "2"] {
        let command = "bench --generate 40 --policies RANDOM,GREEDY --quiet --jobs";
        run(&format!("{command} {jobs} --out made-{jobs}"));
    }
    let table = |name: &str| read(&folder.path().join(name).join("makespans.csv"));
    assert_eq!(table("made-1"), table("made-2"));
    assert_eq!(table("made-1").lines().count(), 1 + 40 * 4);
    run("bench made-1/problems --policies RANDOM,GREEDY --quiet --limit 3 --out read");
    assert!(table("made-1").starts_with(&table("read")), "{}", table("read"));
}

#[test]
fn bad_input_is_told_all_at_once_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("none")).unwrap();
    let bad = PUBLISHED.replace("[1,1,0],[0,0,0]]", "[1,1],[0,0,0]]").replace("[[7,3]]", "[[7,3],[3,7]]");
    std::fs::write(folder.path().join("bad.json"), bad.replace("93,", "NaN,")).unwrap();
    std::fs::write(folder.path().join("worse.json"), bad).unwrap();
    let says = |words: &str, says: &[&str]| refused(folder.path(), 2, words, says);
    says("bench bad.json --out out", &["bad.json: T_e[1]: must be a finite number, found \"NaN\""]);
    let row = "worse.json: R[8]: must have a number for each of the 3 skills of Q[0], found 2";
    let circle = "worse.json: precedence_constraints: must have no circle";
    says("bench worse.json --out out", &[row, circle]);
    says("bench . --out out", &["bad.json: T_e[1]", row, circle]);
    says("bench none", &["none: must have problems (.json), found none"]);
    says("bench absent.json", &["absent.json"]);
    says("bench --generate 1 --policies ENG --out out", &["policy ENG needs the energy level"]);
    says("bench --generate 1 --policies NOBODY", &["--policies", "NOBODY"]);
    says("bench --generate 1 --policies ORACLE", &["ORACLE plays the trial that asks"]);
    assert!(!folder.path().join("out").exists());
}
