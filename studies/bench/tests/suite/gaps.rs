//! `usar bench`: gaps of policies to the optimum of problems of task allocation.

use crate::support::{json, read, refuses, succeeds, usar};

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
    let said = found["sentences"][0].as_str().unwrap();
    assert!(said.starts_with("1 problem, 1 of them solved exactly"), "{said}");
    let gap = found["tables"]["methods"][0]["worst"].as_f64().unwrap();
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
    let program = read(&folder.path().join("made-1/program.json"));
    assert!(program.contains(&format!("\"study\": \"{}\"", mrta::STUDY)), "{program}");
    run("bench made-1/problems --policies RANDOM,GREEDY --quiet --limit 3 --out read");
    assert!(table("made-1").starts_with(&table("read")), "{}", table("read"));
}

/// A problem in the form of `HeteroMRTA`: a task of 5, a robot whose depot is 3 away, and a useless robot.
const HETERO: &str = r#"{"setup": {"robots": 2, "tasks": 1, "num_skills": 2},
    "tasks": {"0": {"pos": {"x": 3, "y": 4}, "skillset": {"0": 1, "1": 0}, "duration": 5}},
    "robots": {"0": {"pose": {"x": 0, "y": 0}, "skillset": {"0": 0, "1": 1}},
        "1": {"pose": {"x": 3, "y": 1}, "skillset": {"0": 1, "1": 0}}}}"#;

#[test]
fn a_folder_stands_for_its_files_and_for_the_config_of_its_subfolders() {
    let folder = tempfile::tempdir().unwrap();
    let set = folder.path().join("set");
    for name in ["env_0", "env_1", "empty"] {
        std::fs::create_dir_all(set.join(name)).unwrap();
    }
    std::fs::write(set.join("env_0/config.json"), HETERO).unwrap();
    std::fs::write(set.join("env_1/config.json"), HETERO.replace("5}", "6}")).unwrap();
    std::fs::write(set.join("env_1/other.json"), "{").unwrap();
    std::fs::write(set.join("1p_000000.json"), PUBLISHED).unwrap();
    let run = |words: &str| succeeds(&usar(folder.path(), words));
    run("bench set --policies DIS --quiet --out all");
    let table = read(&folder.path().join("all/makespans.csv"));
    let row = |row: usize| table.lines().nth(row).unwrap();
    assert!(row(1).starts_with("1p_000000,570.167"), "{table}");
    assert_eq!([row(4), row(9)], ["env_0,35,EARLIEST,35,0", "env_1,36,DIS,36,0"]);
    run("bench set/env_0/config.json --policies DIS --quiet --out one");
    assert_eq!(read(&folder.path().join("one/makespans.csv")).lines().nth(1), Some(row(4)));
    refuses(&usar(&set, "bench env_1"), &["other.json: the text is not JSON"]);
    std::fs::write(set.join("env_1/config.json"), HETERO.replace("\"x\": 3", "\"x\": NaN")).unwrap();
    let [pos, pose] = ["tasks.0.pos.x", "robots.1.pose.x"];
    let finite = "must be a finite number, found \"NaN\"";
    let told = [pos, pose].map(|field| format!("set/env_1/config.json: {field}: {finite}"));
    refuses(&usar(folder.path(), "bench set --out out"), &[&told[0], &told[1]]);
}

#[test]
fn bad_input_is_told_all_at_once_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("none")).unwrap();
    let bad = PUBLISHED.replace("[1,1,0],[0,0,0]]", "[1,1],[0,0,0]]").replace("[[7,3]]", "[[7,3],[3,7]]");
    std::fs::write(folder.path().join("bad.json"), bad.replace("93,", "NaN,")).unwrap();
    std::fs::write(folder.path().join("worse.json"), bad).unwrap();
    let says = |words: &str, says: &[&str]| refuses(&usar(folder.path(), words), says);
    says("bench bad.json --out out", &["bad.json: T_e[1]: must be a finite number, found \"NaN\""]);
    let row = "worse.json: R[8]: must have a number for each of the 3 skills of Q[0], found 2";
    let circle = "worse.json: precedence_constraints: must have no circle";
    says("bench worse.json --out out", &[row, circle]);
    says("bench . --out out", &["bad.json: T_e[1]", row, circle]);
    says("bench none", &["none: must have problems (.json, or config.json in subfolders), found none"]);
    says("bench absent.json", &["absent.json"]);
    says("bench --generate 1 --policies ENG --out out", &["policy ENG needs the energy level"]);
    says("bench --generate 1 --policies NOBODY", &["--policies", "NOBODY"]);
    says("bench --generate 1 --policies ORACLE", &["ORACLE plays the trial that asks"]);
    assert!(!folder.path().join("out").exists());
}
