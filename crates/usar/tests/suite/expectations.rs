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

/// In 20 s nobody can be rescued, and two names of one policy end alike to the last bit.
#[test]
fn what_cannot_differ_is_the_same_in_every_command() {
    let folder = place();
    let here = folder.path();
    let sweep = "(name: \"floor\", scenario: \"short.ron\", policies: [\"RNE\", \"DIS\", \"twin=DIS\"],
        trials: 20, set: {\"duration_s\": 20.0}, margins: {\"rescuees.total\": 5.0}, baseline: \"DIS\",
        primary: [\"rescuees.total\", \"distance\"], keep: Trials,
        expect: [\"rescuees.total: RNE = DIS within 5\", \"distance: twin > DIS\"])";
    std::fs::write(here.join("floor.ron"), sweep).unwrap();
    succeeds(&usar(here, "sweep floor.ron --quiet"));
    let json: Value =
        serde_json::from_str(&succeeds(&usar(here, "compare results/floor --json --metric all"))).unwrap();
    let of = |metric: &str, a: &str| {
        let all = json["tables"]["comparisons"].as_array().unwrap();
        all.iter().find(|one| one["metric"] == metric && one["a"] == a).unwrap().clone()
    };
    for (metric, a) in [("rescuees.total", "RNE"), ("rescuees.total", "twin"), ("distance", "twin")] {
        let one = of(metric, a);
        assert_eq!((&one["verdict"], &one["difference"]), (&"same".into(), &0.0.into()), "{metric}, {a}");
        assert!(one["p"].is_null() && one["interval"].is_null(), "nothing is tested: {one}");
    }
    assert_ne!(of("distance", "RNE")["verdict"], "same");
    let text = succeeds(&usar(here, "compare results/floor"));
    assert!(text.starts_with("rescuees.total: RNE the same as DIS, twin the same as DIS."), "{text}");
    assert!(text.contains("The same means the same in all trials: nothing is tested."), "{text}");
    assert!(!text.contains("equivalent") && !text.contains("within"), "{text}");
    succeeds(&usar(here, "report results/floor"));
    assert!(
        std::fs::read_to_string(here.join("results/floor/report.html"))
            .unwrap()
            .contains("RNE and DIS are the same in all trials (n = 20)")
    );
    let output = usar(here, "test floor.ron --max-trials 20 --quiet");
    let text = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "an expectation that nothing can refute does not hold");
    assert_eq!(text.matches("THE SAME  floor.ron: ").count(), 2, "{text}");
    assert_eq!(text.matches("n = 20; the same in all trials)").count(), 2, "{text}");
}
