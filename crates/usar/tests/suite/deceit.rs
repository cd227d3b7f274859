//! Robots that lie: what is said beside what is true, and how much room a world has for a lie to matter.

use crate::support::{read, succeeds, usar};

/// Four carriers in unequal health for a far and a near task.
const TWO: &str = "(name: \"two\", duration_s: 120.0, dt_s: 0.02, arena_m: (60.0, 30.0),
    team: [(role: \"carrier\", count: 4, center: (6.0, 15.0), width_m: 6.0)],
    roles: [(name: \"carrier\", observing_m: 6.0, capacity: 2, resources: 4)],
    initial_levels: (hp: (mean: 60.0, sd: 30.0)),
    tasks: [
        (name: \"far\", difficulty: 2, center: (50.0, 22.0), size_m: (8.0, 8.0), grid: (5, 5),
            rest: (4.0, 4.0)),
        (name: \"near\", difficulty: 1, center: (24.0, 8.0), size_m: (8.0, 8.0), grid: (5, 5),
            rest: (8.0, 4.0)),
    ],
    mission: (hp_threshold: 0.0, health_floor: 0.1),
)";

/// A world in which none or two of four robots say 100 % health.
const LIED: &str = "(name: \"lied\", scenario: \"two.ron\", trials: 12, baseline: \"RANDOM\", keep: Trials,
    policies: [\"RANDOM\", \"DIS <- Truth\", \"DIS <- Beta\", \"HP_DIS\", \"sure=HP_DIS <- Truth\"],
    set: {\"deceit\": [(who: Count(0), lie: Exaggerate(by: 1), on: [Hp])]},
    axes: {\"deceit[0].who\": [Count(2), Count(0)]}, primary: [\"rescuees.total\"],
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
    let rows = json["tables"]["worlds"][0]["policies"].as_array().unwrap();
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
    let all = succeeds(&usar(folder.path(), "study room results/room-two results/room-two --format csv"));
    let rows: Vec<&str> = all.lines().filter(|line| line.starts_with("two,")).collect();
    assert!(
        all.starts_with("world,RANDOM,RNE,DIS,best,worst") && rows.len() == 2 && rows[0] == rows[1],
        "{all}"
    );
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
    std::fs::write(here.join("question.json"), why["tables"]["account"][0]["question"].to_string()).unwrap();
    let counted = |policy: &str| -> f64 {
        let answer = succeeds(&usar(here, &["trust", "question.json", "--policy", policy, "--json"]));
        let decision: serde_json::Value = serde_json::from_str(&answer).unwrap();
        let roles = decision["account"]["Ranking"]["roles"].as_array().unwrap();
        let mut robots = roles.iter().flat_map(|role| role.as_array().unwrap());
        robots.find(|robot| robot["id"] == 1).unwrap()["value"].as_f64().unwrap()
    };
    let [said, last, seen] =
        ["HP_DIS", "HP_DIS <- LastReport", "x=HP_DIS <- DeadReckoning | Discount"].map(counted);
    assert!((said - 31.0).abs() < 1e-9 && (last - 31.0).abs() < 1e-9 && seen > 50.0, "{said} {last} {seen}");
    let refused = |arguments: &[&str], reason: &str| {
        let output = usar(here, arguments);
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && told.contains(reason), "{told}");
    };
    let by_truth = ["trust", "question.json", "--policy", "HP_DIS <- Truth"];
    refused(
        &by_truth,
        "question.json: Truth takes the levels of robots as they really are; here nobody knows them",
    );
    refused(&["trust", "question.json", "--policy", "HP_DIS <- Kalmann"], "did you mean Kalman?");
    refused(
        &["run", "lie.ron", "--policy", "HP_DIS <- Beta | Exclude"],
        "mission.may_idle must be true for HP_DIS <- Beta | Exclude, which leaves robots idle, found false",
    );
}

/// Two liars of four say 100 % health: `Truth` knows better, reports alone do not.
#[test]
fn a_study_of_deceit_tells_what_lies_cost_and_how_well_estimators_judge() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("two.ron"), TWO).unwrap();
    std::fs::write(here.join("lied.ron"), LIED).unwrap();
    let text = succeeds(&usar(here, "study deceit lied.ron --quiet"));
    for part in ["rescuees.total: 12 pairs by seed, minus RANDOM; margin 0", "breaks down", "The price where"]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
    let json = succeeds(&usar(here, "study deceit lied.ron --quiet --json"));
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let json = &json["tables"];
    let policies = json["policies"].as_array().unwrap();
    let mean = |policy: usize, place: usize| policies[policy][["0", "2"][place]].as_f64().unwrap();
    assert_eq!(policies.iter().map(|one| &one["policy"]).collect::<Vec<_>>(), ["HP_DIS", "sure"]);
    assert!((mean(1, 0) - mean(1, 1)).abs() < 1e-9, "who knows the truth hears no lie");
    assert!((mean(0, 0) - mean(1, 0)).abs() < 1e-9 && (mean(0, 1) - mean(1, 1)).abs() > 0.1, "{json}");
    assert_eq!(
        (&json["prices"][0]["policy"], &json["prices"][0]["difference"]),
        (&"sure".into(), &0.0.into())
    );
    let judged = json["judgements"].as_array().unwrap();
    let value = |row: usize, name: &str| judged[row][name].as_f64();
    let rows: Vec<(&str, u64)> = judged
        .iter()
        .map(|row| (row["estimator"].as_str().unwrap(), row["liars"].as_u64().unwrap()))
        .collect();
    assert_eq!(rows, [("Truth", 0), ("Truth", 2), ("Beta", 0), ("Beta", 2)]);
    assert_eq!((value(1, "level_mae"), value(2, "level_mae")), (Some(0.0), Some(0.0)));
    assert!(value(3, "level_mae").unwrap() > 3.0 && value(1, "tau_b").unwrap() > 0.999, "{json}");
    assert_eq!(
        (value(2, "trust_auc"), value(1, "trust_auc")),
        (None, Some(0.5)),
        "nobody lies; all are believed"
    );
    assert!(value(3, "trust_auc").unwrap() > 0.6 && value(3, "rounds_to_detect").is_some(), "{json}");
    let file = |name: &str| std::fs::read_to_string(here.join("results/lied").join(name)).unwrap();
    let above = file("deceit-above-draw.csv");
    let cells: Vec<Vec<&str>> = above.lines().skip(1).map(|row| row.rsplit(',').collect()).collect();
    assert_eq!(cells.len(), 4, "two policies, none and two liars: {above}");
    assert_eq!(cells[2][2], cells[3][2], "who knows the truth hears no lie: {above}");
    assert!(cells[0][2] != cells[1][2] && file("deceit-above-draw.svg").contains(">liars<"), "{above}");
    let other = LIED.replace("\"deceit[0].who\": [Count(2), Count(0)]", "\"dt_s\": [0.02, 0.04]");
    std::fs::write(here.join("other.ron"), other).unwrap();
    let refused = usar(here, "study deceit other.ron --out nowhere");
    let stderr = String::from_utf8_lossy(&refused.stderr);
    assert!(stderr.contains("other.ron: must have an axis of who lies, such as"), "{stderr}");
    assert!(refused.status.code() == Some(2) && !here.join("nowhere").exists());
}

/// Two pairs name no breakdown point. Of a cost, less is better, and the differences are those of `compare`.
#[test]
fn a_study_of_deceit_judges_as_a_comparison_does() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("two.ron"), TWO).unwrap();
    std::fs::write(here.join("lied.ron"), LIED.replace("rescuees.total", "energy_per_rescuee.total"))
        .unwrap();
    let few = succeeds(&usar(here, "study deceit lied.ron --quiet --trials 2 --out few --json"));
    let few: serde_json::Value = serde_json::from_str(&few).unwrap();
    let table = succeeds(&usar(here, "study deceit few"));
    let reason = "no breakdown point: 2 of the 6 distinct pairs of trials that a test takes";
    assert_eq!(table.split_whitespace().collect::<Vec<_>>().join(" ").matches(reason).count(), 2, "{table}");
    assert!(few["tables"]["policies"][0]["breaks down"][0].is_null(), "{few}");
    let csv = std::fs::read_to_string(here.join("few/deceit-above-draw.csv")).unwrap();
    assert!(csv.lines().skip(1).all(|row| row.ends_with(",,")), "no interval of two pairs: {csv}");

    succeeds(&usar(here, "study deceit lied.ron --quiet"));
    let compared = "compare results/lied --json --metric energy_per_rescuee.total --baseline RANDOM";
    let compared: serde_json::Value = serde_json::from_str(&succeeds(&usar(here, compared))).unwrap();
    let mut above = csv::Reader::from_path(here.join("results/lied/deceit-above-draw.csv")).unwrap();
    let mut found = 0;
    for row in above.records().map(Result::unwrap) {
        let liars = format!("Count({})", &row[2]);
        let all = compared["tables"]["comparisons"].as_array().unwrap();
        let is_it = |one: &&serde_json::Value| one["a"] == row[0] && one["axes"][0][1] == liars.as_str();
        let there = all.iter().find(is_it).unwrap();
        let difference = there["difference"].as_f64().unwrap();
        assert!((row[3].parse::<f64>().unwrap() - difference).abs() < 1e-9, "{row:?}, {there}");
        found += usize::from(there["is_of_sums"] == true);
    }
    assert_eq!(found, 4, "some trial has few rescuees: {compared}");
}

#[test]
fn an_estimator_without_reports_is_told_of_in_a_single_trial() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("two.ron"), TWO).unwrap();
    let told = |policy| {
        let output =
            usar(folder.path(), &["run", "two.ron", "--policy", policy, "--set", "duration_s=1.0"][..]);
        String::from_utf8(output.stderr).unwrap()
    };
    assert!(told("DIS <- Beta").contains("note: two.ron: DIS <- Beta: two has no reports"), "it is told");
    assert_eq!(told("DIS"), "");
}
