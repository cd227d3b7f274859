//! Calibration: its results, its interruptions, and its refusals.

use scenario::Scenario;

use crate::support::{read, refuses as refused, succeeds, two_minutes as place, usar};

fn calibrate<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut arguments = vec!["yang2021", "calibrate", "short.ron", "--target", "target.csv", "--trials", "2"];
    arguments.extend(["--fresh-trials", "2", "--quiet", "--out", out]);
    arguments.extend(["--over", "roles.carrier.speed_mps + roles.supplier.speed_mps=1..4"]);
    arguments.extend([
        "--over",
        "radiation[*].radius_m = 2..6",
        "--over",
        "costs.energy.per_step=0.001..0.02 log",
    ]);
    arguments.extend(more);
    arguments
}

#[test]
fn a_calibration_that_was_broken_off_ends_as_one_that_was_not() {
    let place = place();
    let folder = place.path();
    let whole = succeeds(&usar(folder, &calibrate("whole", &["--evaluations", "8", "--jobs", "1"])));
    succeeds(&usar(folder, &calibrate("parts", &["--evaluations", "3", "--jobs", "2"])));
    let log = folder.join("parts/evaluations.jsonl");
    let text = read(&log);
    std::fs::write(&log, &text[..text.len() - 5]).unwrap(); // killed while it wrote a line
    let parts = succeeds(&usar(folder, &calibrate("parts", &["--evaluations", "8", "--jobs", "2"])));
    assert_eq!(parts, whole);
    for file in ["evaluations.jsonl", "calibrated.ron", "fit.csv", "calibration.json"] {
        assert_eq!(read(&folder.join("parts").join(file)), read(&folder.join("whole").join(file)), "{file}");
    }
    // A changed bit in any cell of a line is noticed: no number of a log can change silently.
    let line = text.lines().nth(2).unwrap();
    for at in (0..line.len()).step_by(7) {
        let mut changed = text.clone().into_bytes();
        changed[text.find(line).unwrap() + at] ^= 1;
        std::fs::write(&log, changed).unwrap();
        let output = usar(folder, &calibrate("parts", &["--evaluations", "8", "--jobs", "2"]));
        refused(&output, &["evaluations.jsonl:"]);
    }
    let (scenario, text) = Scenario::load(&folder.join("whole/calibrated.ron")).unwrap();
    assert_eq!(scenario.name, "paper-fitted");
    assert!(text.starts_with("// Fitted by usar yang2021 calibrate (misfit "), "{text}");
    assert!(text.contains("// Places [view]"), "comments stay");
    no_other_policy_runs_in(folder, "whole/calibrated.ron");
    assert_eq!(scenario.roles[0].speed_mps.to_bits(), scenario.roles[1].speed_mps.to_bits());
    assert!(
        scenario
            .radiation
            .iter()
            .all(|zone| zone.radius_m.to_bits() == scenario.radiation[0].radius_m.to_bits())
    );
    assert!(whole.contains("roles.carrier.speed_mps = ") && whole.contains("rescuees_hard"), "{whole}");
}

/// Before a candidate is chosen, only the calibrated policy runs in it.
#[track_caller]
fn no_other_policy_runs_in(folder: &std::path::Path, file: &str) {
    let message = ["only_policy allows DIS alone"];
    for arguments in [
        vec!["run", file, "--policy", "RNE"],
        vec!["sweep", file, "--policies", "DIS,RNE"],
        vec!["cluster", "submit", file, "--policies", "RNE", "--shards", "1"],
        vec!["view", file, "--policy", "RNE", "--no-open"],
        vec!["fork", file, "--round", "1", "--instead", "RNE"],
        vec!["oracle", file],
    ] {
        refused(&usar(folder, &arguments), &message);
    }
    let set = ["run", file, "--policy", "RNE", "--set", "only_policy=\"\""];
    refused(&usar(folder, &set), &["only_policy: decides no number of a trial"]);
    succeeds(&usar(folder, &["run", file, "--policy", "DIS", "--quiet"]));
}

#[test]
fn what_cannot_be_calibrated_is_refused() {
    let place = place();
    let folder = place.path();
    let run = |more: &[&str]| usar(folder, &calibrate("out", more));
    refused(
        &run(&["--over", "roles.carrier.wings=1..2"]),
        &["--over: roles.carrier.wings is no field; roles.carrier has name, kind, radius_m"],
    );
    refused(
        &run(&["--over", "roles.carrier.capacity=2..8"]),
        &["--over: roles.carrier.capacity: takes whole numbers only"],
    );
    refused(&run(&["--over", "duration_s=60..90"]), &["--over: duration_s: is that of the recorded trials"]);
    refused(&run(&["--set", "radiation[0].radius_m=3.0"]), &["--set: radiation[0].radius_m is free"]);
    refused(
        &run(&["--over", "mission.health_floor=0..1"]),
        &["--over: mission.health_floor must be a number from", "found 0"],
    );
    refused(&run(&["--over", "radiation[0].radius_m=2..3"]), &["radiation[0].radius_m is set twice"]);
    refused(
        &run(&["--set", "mission.loading_s=1.0", "--set", "mission.loading_s=2.0"]),
        &["--set: mission.loading_s is set twice"],
    );
    refused(&run(&["--first-seed", "2"]), &["--first-seed: must be beyond the fresh trials", "found 2"]);
    refused(&run(&["--set", "mission.wings=1"]), &["--set: mission.wings is no field; mission has"]);
    std::fs::write(folder.join("target.csv"), "method,rounds\nDIS,6\nRNE,7\n").unwrap();
    refused(&run(&[]), &["target.csv:3: method must be DIS", "\"RNE\""]);
    let targets = [
        (
            "method,rescued_hard,rounds\nDIS,6,6\n",
            "target.csv:1: \"rescued_hard\" is no column of trials.csv",
        ),
        (
            "method,rounds\r\nDIS,6\r\nDIS,six\r\n",
            "target.csv:3: rounds: must be a number >= 0, found \"six\"",
        ),
        ("method,rounds\nDIS,-1\nDIS,7\n", "target.csv:2: rounds: must be a number >= 0, found \"-1\""),
        (
            "method,time_s,rounds\nDIS,120,6\nDIS,60,7\n",
            "target.csv:3: time_s must be the scenario's duration_s, 120, found 60",
        ),
        (
            "method,rescuees_total,rescuees_hard,rescuees_easy\nDIS,5,2,3\nDIS,9,3,4\n",
            "target.csv:3: rescuees_total must be the sum",
        ),
        (
            "method,rescuees_total,rounds\nDIS,-5,6\nDIS,9,7\n",
            "target.csv:2: rescuees_total: must be a number >= 0",
        ),
        ("method,rounds,rounds\nDIS,6,6\n", "the column \"rounds\" stands twice"),
        ("method,rounds\nDIS,6\n", "must have at least two trials, found 1"),
    ];
    for (text, says) in targets {
        std::fs::write(folder.join("target.csv"), text).unwrap();
        refused(&run(&[]), &[says]);
    }
    std::fs::write(folder.join("target.csv"), "method,rounds\nDIS,6\nDIS,6\n").unwrap();
    refused(&run(&[]), &["rounds must differ between trials"]);
    assert!(!folder.join("out").exists(), "nothing was written");
    std::fs::write(folder.join("target.csv"), "method,rounds\nDIS,6\nDIS,7\n").unwrap();
    succeeds(&run(&["--evaluations", "2"]));
    refused(
        &run(&["--evaluations", "2", "--first-step", "0.2"]),
        &["has the calibration of something else", "first_step: 0.1 there, 0.2 now"],
    );
    std::fs::write(folder.join("target.csv"), "method,rounds\nDIS,6\nDIS,8\n").unwrap();
    refused(&run(&["--evaluations", "2"]), &["target.rounds: [6.5,0.70", "there, [7.0,1.41"]);
    std::fs::write(folder.join("target.csv"), "method,rounds\nDIS,6\nDIS,7\n").unwrap();
    refused(
        &run(&["--evaluations", "2", "--set", "mission.loading_s=3.0"]),
        &["mission.loading_s: 2.0 there, 3.0 now"],
    );
}

#[test]
fn a_search_begins_within_its_ranges() {
    let place = place();
    let folder = place.path();
    let mut arguments =
        calibrate("out", &["--over", "costs.energy.per_metre=0.1..0.2 log", "--evaluations", "1"]);
    arguments.retain(|argument| *argument != "--quiet");
    let output = usar(folder, &arguments);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        told.contains("costs.energy.per_metre is 0, outside its range; the search begins at 0.1"),
        "{told}"
    );
    let printed = succeeds(&output);
    assert!(printed.contains(
        "not in the data, and not looked at: rescuees_easy, energy_easy, hp_hard, hp_easy, rounds"
    ));
    let log = read(&folder.join("out/evaluations.jsonl"));
    let entries = log.lines().map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap());
    let values: Vec<f64> = entries.filter_map(|line| line["entry"]["values"][3].as_f64()).collect();
    assert!(!values.is_empty() && values.iter().all(|value| (0.1..=0.2).contains(value)), "{values:?}");
}
