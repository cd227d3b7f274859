//! Expectations of a sweep's outcome.

use serde_json::Value;

use crate::place::{place, refused};
use crate::support::{succeeds, usar};

fn write(folder: &std::path::Path, expect: &str) {
    let text = format!(
        "(name: \"expected\", scenario: \"short.ron\", policies: [\"RNE\", \"DIS\"], trials: 2, expect: \
         [{expect}])"
    );
    std::fs::write(folder.join("expected.ron"), text).unwrap();
}

#[test]
fn expectations_hold_fail_or_stay_undecided() {
    let folder = place();
    let here = folder.path();
    write(
        here,
        "\"time >= 30 in 90 % of seeds\", \"DIS: time >= 30 in 100 % of seeds\", \"distance: RNE = DIS \
         within 1e6\"",
    );
    let arguments = ["test", "expected.ron", "--max-trials", "80", "--quiet", "--junit", "all.xml"];
    let text = succeeds(&usar(here, &arguments));
    assert_eq!(text.lines().filter(|line| line.starts_with("holds     expected.ron: ")).count(), 3, "{text}");
    let junit = std::fs::read_to_string(here.join("all.xml")).unwrap();
    assert!(junit.contains("tests=\"3\"") && !junit.contains("<failure"), "{junit}");

    write(
        here,
        "\"time > 30 in 50 % of seeds\", \"distance: RNE > DIS by 1e6\", \"rescuees < 1 in 90 % of seeds \
         (99.9 %)\"",
    );
    let output = usar(here, "test expected.ron --max-trials 20 --quiet --json --junit all.xml");
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("3 of 3 expectations do not hold"));
    let told: Value = serde_json::from_slice(&output.stdout).unwrap();
    let verdicts: Vec<&str> = told["tables"]["expectations"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["verdict"].as_str().unwrap())
        .collect();
    assert_eq!(verdicts, ["fails", "fails", "undecided"], "twenty trials cannot show 90 % at 99.9 %");
    let junit = std::fs::read_to_string(here.join("all.xml")).unwrap();
    assert!(junit.matches("<failure").count() == 3 && junit.contains("UNDECIDED: observed 1"), "{junit}");
}

#[test]
fn few_trials_are_run_where_few_decide() {
    let folder = place();
    let here = folder.path();
    write(here, "\"time > 30 in 90 % of seeds\"");
    let output = usar(here, "test expected.ron --max-trials 100000 --quiet --json");
    let told: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(told["tables"]["expectations"][0]["n"], 20, "the first look decides");
}

#[test]
fn what_is_no_expectation_is_told_before_anything_runs() {
    let folder = place();
    let here = folder.path();
    refused(here, 2, "test short.ron", &["short.ron: expects nothing"]);
    write(here, "\"rescuees\"");
    refused(
        here,
        2,
        "test expected.ron",
        &["expected.ron: expect: must be like \"rescuees.total >= 60 in 90 % of seeds\""],
    );
    write(here, "\"rescuees: RNE > ENG\"");
    refused(here, 2, "test expected.ron", &["\"ENG\" must be a policy of the sweep (RNE, DIS)"]);
    write(here, "\"nonsense\", \"rescuees.total: RNE > RNE\"");
    for verb in ["test", "check"] {
        let both =
            ["expected.ron: expect: must be like", "expected.ron: expect: the two policies must differ"];
        refused(here, 2, format!("{verb} expected.ron").as_str(), &both);
    }
}
