//! `usar new`, `list` and `resolve`: scenario files to start from, and their content.

use crate::place::refused;
use crate::support::{read, root, succeeds, usar};

#[test]
fn a_new_scenario_runs_and_nothing_is_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for from in ["paper", "three-tasks"] {
        let name = format!("mine-{from}");
        assert_eq!(succeeds(&usar(here, &["new", &name, "--from", from])), format!("{name}.ron\n"));
        let file = format!("{name}.ron");
        assert_eq!(succeeds(&usar(here, &["check", &file])), format!("{file}: ok\n"));
        assert!(read(&here.join(&file)).contains("// SI units. Points are (x, y) in metres"));
    }
    succeeds(&usar(here, "new small"));
    assert!(succeeds(&usar(here, "run small.ron --check")).contains("rescued      9"));
    refused(here, 2, "new mine-paper", &["mine-paper.ron exists; nothing was overwritten"]);
    refused(here, 2, "new ../mine", &["name must be a name of at most 64 letters"]);
    refused(here, 2, "new a --from papre", &["did you mean paper, which the program carries?"]);
}

#[test]
fn an_errand_without_a_way_is_told_by_check_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let lane = "(format: 2, name: \"lane\", duration_s: 100.0, dt_s: 0.02, arena_m: (12.0, 4.0),\n\
        roles: [(name: \"robot\", radius_m: 0.25)],\n\
        team: [(role: \"robot\", count: 1, center: (2.0, 2.0), width_m: 0.0)],\n\
        errands: [(robot: 0, to: [(9.0, 2.0)])],\n\
        walls: [((6, 1.5), (12, 1.5)), ((6, 2.4), (12, 2.4))])";
    std::fs::write(folder.path().join("lane.ron"), lane).unwrap();
    let output = usar(folder.path(), &["check", "lane.ron"]);
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(told.starts_with("note: lane.ron:4: errands[0].to[0] has no way to it"), "{told}");
    assert_eq!(succeeds(&output), "lane.ron: ok\n");
}

#[test]
fn scenarios_policies_roles_and_metrics_are_listed() {
    let root = root();
    let listed = |arguments: &[&str]| succeeds(&usar(&root, &[&["scenario", "list"], arguments].concat()));
    let carried = listed(&[]);
    assert!(carried.contains("warehouse\tforty robots") && carried.contains("collapse\t"), "{carried}");
    let scenarios = listed(&["scenarios", "scenarios"]);
    assert!(scenarios.contains("scenarios/three-tasks.ron\tNine carriers"), "{scenarios}");
    assert!(!scenarios.contains("sweep"), "{scenarios}");
    let policies = listed(&["policies"]);
    assert!(
        policies.lines().any(|line| line.starts_with("RNE\t") && line.contains("score: MaxOfBoth")),
        "{policies}"
    );
    let estimators = listed(&["estimators"]);
    assert!(
        estimators.contains("Kalman\t") && estimators.contains("(q: 4.0, r: 25.0, gate: 6.6349, restart: 2)"),
        "{estimators}"
    );
    assert!(listed(&["roles"]).contains("carrier\t6 robots; drives at 2.25 m/s"));
    assert!(listed(&["metrics", "scenarios/three-tasks.ron"]).contains("rescuees.medium\t"));
    refused(
        tempfile::tempdir().unwrap().path(),
        2,
        "scenario list scenarios nowhere",
        &["nowhere: cannot be read"],
    );
}

#[test]
fn each_value_is_told_with_its_origin() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    succeeds(&usar(here, "new first"));
    let over = "(\n    base: \"first.ron\", name: \"over\",\n    roles: (carrier: (speed_mps: 3.0)),\n    \
        mission: (loading_s: 1.0),\n    walls: [((5, 14), (15, 14))],\n)";
    std::fs::write(here.join("over.ron"), over).unwrap();
    let told = succeeds(&usar(here, "scenario resolve over.ron --set mission.reach_m=2"));
    let line = |path: &str| {
        let found = told.lines().find(|line| line.split_whitespace().next() == Some(path));
        found.unwrap_or_else(|| panic!("{path}: {told}")).split_whitespace().collect::<Vec<_>>().join(" ")
    };
    for expected in [
        "name = \"over\" # over.ron:2",
        "duration_s = 180.0 # first.ron:12",
        "roles[0].speed_mps = 3.0 # over.ron:3",
        "roles[0].capacity = 6 # first.ron:26",
        "roles[0].mass_kg = 50.0 # default",
        "mission.loading_s = 1.0 # over.ron:4",
        "mission.rest_s = 20.0 # first.ron:48",
        "mission.reach_m = 2.0 # --set",
        "mission.health_floor = 0.5 # default",
        "walls[0].from[0] = 5.0 # over.ron:5",
        "walls[0].thickness_m = 0.2 # default",
    ] {
        assert_eq!(line(expected.split(' ').next().unwrap()), expected);
    }
}
