//! Robots that lie: what is said beside what is true, and how much room a world has for a lie to matter.

use crate::support::{read, succeeds, usar};

/// Four carriers in unequal health for a far and a near task.
const TWO: &str = "(name: \"two\", duration_s: 120.0, dt_s: 0.02, arena_m: (60.0, 30.0),
    team: [(role: \"carrier\", count: 4, center: (6.0, 15.0), width_m: 6.0)],
    roles: [(name: \"carrier\", observing_m: 6.0, capacity: 2, resources: 4)],
    initial_levels: (hp: (mean: 60.0, sd: 30.0)),
    tasks: [
        (name: \"far\", difficulty: 2, center: (50.0, 22.0), size_m: (8.0, 8.0), grid: (5, 5), rest: (4.0, 4.0)),
        (name: \"near\", difficulty: 1, center: (24.0, 8.0), size_m: (8.0, 8.0), grid: (5, 5), rest: (8.0, 4.0)),
    ],
    mission: (hp_threshold: 0.0, health_floor: 0.1),
)";

#[test]
fn the_room_of_a_world_is_that_of_its_trials() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("two.ron"), TWO).unwrap();
    let command = "study room two.ron --trials 8 --policies RNE,DIS --quiet";
    let text = succeeds(&usar(folder.path(), command));
    assert!(text.contains("rescuees.total of 8 trials, paired by seed; minus RANDOM"), "{text}");
    let json = succeeds(&usar(folder.path(), &format!("{command} --json")[..]));
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let rows = json["rows"].as_array().unwrap();
    let policies: Vec<&str> = rows.iter().map(|row| row["policy"].as_str().unwrap()).collect();
    assert_eq!(policies, ["RNE", "DIS", "RANDOM", "best", "worst"]);
    let mean = |policy: usize| rows[policy]["mean"].as_f64().unwrap();
    assert!(mean(4) < mean(2) && mean(2) < mean(3), "{text}");
    assert!(rows[2]["difference"].is_null() && rows[3]["difference"].is_f64(), "{json}");
    let mut trials = csv::Reader::from_path(folder.path().join("results/room-two/trials.csv")).unwrap();
    let place =
        |name: &str, header: &csv::StringRecord| header.iter().position(|known| known == name).unwrap();
    let header = trials.headers().unwrap().clone();
    let [policy, rescued] = ["policy", "rescuees_total"].map(|name| place(name, &header));
    let of_rne: Vec<f64> = trials
        .records()
        .map(Result::unwrap)
        .filter(|row| &row[policy] == "RNE")
        .map(|row| row[rescued].parse().unwrap())
        .collect();
    assert_eq!(of_rne.len(), 8);
    assert!((of_rne.iter().sum::<f64>() / 8.0 - mean(0)).abs() < 1e-9);
}

#[test]
fn why_shows_what_was_said_beside_what_is_true() {
    let folder = tempfile::tempdir().unwrap();
    succeeds(&usar(folder.path(), "new small"));
    let honest = read(&folder.path().join("small.ron"));
    let lie = "deceit: [(who: Robots([1]), lie: Uniform(low: 31, high: 31), on: [Hp])],\n    tasks: [";
    std::fs::write(folder.path().join("lie.ron"), honest.replacen("tasks: [", lie, 1)).unwrap();
    let told =
        |file: &str| succeeds(&usar(folder.path(), &format!("why {file} --policy HP_DIS --seed 1")[..]));
    assert!(!told("small.ron").contains("HP said"), "everybody knows how every robot is");
    let told = told("lie.ron");
    let row = |id: &str| -> Vec<String> {
        let cells =
            |line: &str| line.split(['│', '┆']).map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
        told.lines().map(cells).find(|cells| cells.len() > 7 && cells[1] == id).unwrap()
    };
    let (liar, other) = (row("1"), row("0"));
    assert_eq!((liar[5].as_str(), other[5] == other[6]), ("31.0", true), "{told}");
    assert!(liar[6].parse::<f64>().unwrap() > 50.0, "{told}");
}

/// Robot 1 says 31 % health. A policy behind an estimator that knows better counts with what is true.
#[test]
fn a_policy_behind_an_estimator_answers_a_question_with_evidence() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    succeeds(&usar(here, "new small"));
    let lie = "deceit: [(who: Robots([1]), lie: Uniform(low: 31, high: 31), on: [Hp])],\n    tasks: [";
    let small = read(&here.join("small.ron"));
    std::fs::write(here.join("lie.ron"), small.replacen("tasks: [", lie, 1)).unwrap();
    let why = succeeds(&usar(here, "why lie.ron --policy HP_DIS --seed 1 --json"));
    let why: serde_json::Value = serde_json::from_str(&why).unwrap();
    std::fs::write(here.join("question.json"), why["question"].to_string()).unwrap();
    let counted = |policy: &str| -> f64 {
        let answer = succeeds(&usar(here, &["trust", "question.json", "--policy", policy, "--json"]));
        let decision: serde_json::Value = serde_json::from_str(&answer).unwrap();
        let roles = decision["account"]["Ranking"]["roles"].as_array().unwrap();
        let mut robots = roles.iter().flat_map(|role| role.as_array().unwrap());
        robots.find(|robot| robot["id"] == 1).unwrap()["value"].as_f64().unwrap()
    };
    let [said, last, truth] = ["HP_DIS", "HP_DIS <- LastReport", "x=HP_DIS <- Truth | Discount"].map(counted);
    assert!(
        (said - 31.0).abs() < 1e-9 && (last - 31.0).abs() < 1e-9 && truth > 50.0,
        "{said} {last} {truth}"
    );
    let refused = |arguments: &[&str], reason: &str| {
        let output = usar(here, arguments);
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && told.contains(reason), "{told}");
    };
    refused(&["trust", "question.json", "--policy", "HP_DIS <- Kalmann"], "did you mean Kalman?");
    refused(
        &["run", "lie.ron", "--policy", "HP_DIS <- Beta | Exclude"],
        "mission.may_idle must be true for HP_DIS <- Beta | Exclude, which leaves robots idle, found false",
    );
}
