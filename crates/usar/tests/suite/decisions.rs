//! Single decisions: changed, played in all ways, and explained.

use serde_json::Value;

use crate::place::{place, refused};
use crate::support::{succeeds, usar};

/// The paper's scenario with two robots of each role, and therefore eight assignments, and with three short
/// rounds.
const SMALL: [&str; 8] = [
    "short.ron",
    "--set",
    "team[0].count=2",
    "--set",
    "team[1].count=2",
    "--set",
    "duration_s=250",
    "--json",
];

fn json(folder: &std::path::Path, verb: &str, rest: &[&str]) -> Value {
    let arguments = [&[verb], &SMALL[..], rest].concat();
    serde_json::from_str(&succeeds(&usar(folder, &arguments))).unwrap()
}

fn groups(row: &Value) -> String {
    let ids = |group: &Value| {
        let ids: Vec<String> = group.as_array().unwrap().iter().map(Value::to_string).collect();
        ids.join(",")
    };
    format!("hard={}; easy={}", ids(&row["hard group"]), ids(&row["easy group"]))
}

#[test]
fn the_oracles_best_and_worst_assignments_come_out_of_a_fork() {
    let folder = place();
    let here = folder.path();
    for round in ["1", "2", "3"] {
        let found = json(here, "oracle", &["--round", round, "--metric", "energy_per_rescuee", "--quiet"]);
        let ranking = found["tables"]["ranking"].as_array().unwrap();
        let said = found["sentences"][1].as_str().unwrap();
        assert!(ranking.len() == 8 && said.ends_with("all 8 assignments that the quotas allow"), "{said}");
        for ranked in [&ranking[0], &ranking[7]] {
            let assign = groups(ranked);
            let fork = json(here, "fork", &["--round", round, "--assign", &assign]);
            let outcome = &fork["tables"]["trials"][1]["round"];
            assert_eq!(outcome["duration_s"], ranked["time s"], "round {round}, {assign}");
            let rescued = [0, 1].map(|task: usize| outcome["tasks"][task]["rescued"].clone());
            assert_eq!(Value::from(rescued.to_vec()), ranked["rescued"], "round {round}, {assign}");
        }
        let values: Vec<f64> =
            ranking.iter().map(|ranked| ranked["energy_per_rescuee.total"].as_f64().unwrap()).collect();
        assert!(values.is_sorted(), "a cost: less is better: {values:?}");
        let policies = found["tables"]["policies"].as_array().unwrap();
        let rne = policies.iter().find(|choice| choice["policy"] == "RNE").unwrap();
        let regret = rne["energy_per_rescuee.total"].as_f64().unwrap() - values[0];
        assert!((rne["regret"].as_f64().unwrap() - regret).abs() < 1e-12);
        let better =
            values.iter().filter(|value| **value < rne["energy_per_rescuee.total"].as_f64().unwrap()).count();
        assert_eq!(rne["rank"], better + 1);
    }
}

#[test]
fn an_oracle_that_was_broken_off_goes_on_and_says_the_same() {
    let folder = place();
    let here = folder.path();
    let first = json(here, "oracle", &["--then", "RNE,DIS", "--quiet"]);
    let cache = std::fs::read_dir(here.join("results/oracle")).unwrap().next().unwrap().unwrap().path();
    let lines = std::fs::read_to_string(&cache).unwrap();
    assert_eq!(lines.lines().count(), 1 + 16);
    std::fs::write(&cache, &lines[..lines.len() / 3]).unwrap();
    assert_eq!(json(here, "oracle", &["--then", "RNE,DIS", "--quiet"]), first);
    let sorted = |text: &str| {
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        lines.sort();
        lines
    };
    assert_eq!(sorted(&std::fs::read_to_string(&cache).unwrap()), sorted(&lines));
}

#[test]
fn a_forged_digit_in_the_oracles_log_is_refused_and_nobody_else_cuts_it() {
    let folder = place();
    let here = folder.path();
    json(here, "oracle", &["--quiet"]);
    let cache = std::fs::read_dir(here.join("results/oracle")).unwrap().next().unwrap().unwrap().path();
    let text = std::fs::read_to_string(&cache).unwrap();
    let number = text.lines().count();
    let at = text.rfind("\"rescued\":").unwrap() + "\"rescued\":".len();
    let digit = if &text[at..=at] == "9" { "8" } else { "9" };
    std::fs::write(&cache, format!("{}{digit}{}", &text[..at], &text[at + 1..])).unwrap();
    let line = format!(".jsonl:{number}: the checksum does not match: the line was changed.");
    refused(here, 2, &[&["oracle"], &SMALL[..], &["--quiet"]].concat(), &[&line]);
    refused(here, 2, &[&["why"], &SMALL[..]].concat(), &[&line]);
    // The end of a killed process is cut off by the next writer, and left alone by a reader.
    std::fs::write(&cache, &text[..text.len() - 9]).unwrap();
    assert_eq!(
        json(here, "why", &[])["tables"]["account"][0]["oracle"],
        serde_json::json!([]),
        "an assignment is missing"
    );
    assert_eq!(std::fs::read_to_string(&cache).unwrap(), text[..text.len() - 9]);
    json(here, "oracle", &["--quiet"]);
    assert_eq!(std::fs::read_to_string(&cache).unwrap(), text);
    assert_eq!(json(here, "why", &[])["tables"]["account"][0]["oracle"].as_array().unwrap().len(), 2);
}

#[test]
fn a_study_of_regret_overwrites_no_files_of_others() {
    let folder = place();
    let here = folder.path();
    let results = here.join("results");
    std::fs::create_dir_all(&results).unwrap();
    for name in ["summary.json", "regret.csv"] {
        std::fs::write(results.join(name), "MINE\n").unwrap();
        let study =
            ["study", "regret", "short.ron", "--trials", "1", "--rounds", "1", "--quiet", "--out", "results"];
        refused(here, 2, &study, &["results is not empty and not the folder of a study of regret"]);
    }
}

#[test]
fn a_fork_without_a_change_is_the_same_trial_and_one_with_a_change_is_not() {
    let folder = place();
    let here = folder.path();
    let fork = json(here, "fork", &["--round", "2", "--instead", "RNE", "--onwards"]);
    let run = json(here, "run", &["--policy", "RNE"]);
    let trials = &fork["tables"]["trials"];
    assert_eq!((&trials[0]["state_hash"], &trials[1]), (&run["state_hash"], &trials[0]));
    let fork = json(here, "fork", &["--round", "1", "--instead", "HP_DIS"]);
    let trials = &fork["tables"]["trials"];
    assert_ne!(trials[1]["state_hash"], run["state_hash"]);
    assert_ne!(trials[1]["assignment"], trials[0]["assignment"]);
}

#[test]
fn the_oracle_as_a_policy_decides_as_the_oracle_says() {
    let folder = place();
    let here = folder.path();
    let policy = "ORACLE(metric: \"energy_per_rescuee\")";
    let run = json(here, "run", &["--policy", policy]);
    for (place, decision) in run["decisions"].as_array().unwrap().iter().take(2).enumerate() {
        let round = (place + 1).to_string();
        let rest = ["--policy", policy, "--round", &round, "--metric", "energy_per_rescuee", "--quiet"];
        let best = &json(here, "oracle", &rest)["tables"]["ranking"][0];
        let best = [&best["hard group"], &best["easy group"]].map(Value::clone);
        assert_eq!(decision["decision"]["assignment"]["groups"], Value::from(best.to_vec()), "round {round}");
    }
    refused(
        here,
        2,
        &["run", "short.ron", "--policy", "ORACLE(limit: 1)"],
        &["limit must be from 2 to 1000000, found 1"],
    );
    let text = "id,role,x,y,energy_level\n0,walker,0,0,5\n1,walker,1,0,6\n";
    std::fs::write(here.join("team.csv"), text.replace("energy_level", "eng")).unwrap();
    refused(here, 2, "trust team.csv --policy ORACLE", &["here is no trial"]);
}

/// The RNE between the groups of the first round, computed from the recorded needs.
#[test]
fn why_is_what_the_recorded_needs_say() {
    let folder = place();
    let told = json(folder.path(), "why", &["--round", "1", "--robot", "0"]);
    let told = &told["tables"]["account"][0];
    let members = told["question"]["members"].as_array().unwrap();
    let needs = |member: &Value| -> Vec<f64> {
        member["needs"].as_array().unwrap().iter().map(|need| need.as_f64().unwrap()).collect()
    };
    let count = needs(&members[0]).len();
    let maximum = |k: usize| members.iter().map(|member| needs(member)[k]).fold(0.0, f64::max);
    let pair = &told["directed"][0];
    let shares = ["from", "to"].map(|side| {
        let task = pair[side].as_u64().unwrap() as usize;
        let group = told["decision"]["assignment"]["groups"][task].as_array().unwrap();
        let sum = |k: usize| {
            let of_group = members.iter().filter(|member| group.contains(&member["id"]));
            let scale = if maximum(k) > 0.0 { 1.0 / maximum(k) } else { 0.0 };
            of_group.map(|member| needs(member)[k] * scale).sum::<f64>()
        };
        let all: f64 = (0..count).map(sum).sum();
        (0..count).map(|k| sum(k) / all).collect::<Vec<f64>>()
    });
    let weights: Vec<&Value> =
        told["question"]["needs"].as_array().unwrap().iter().map(|need| &need["weight"]).collect();
    assert!(weights.iter().all(|weight| **weight == 1.0), "the shares above have no weights");
    let mut total = 0.0;
    for k in 0..count {
        let by_hand =
            if shares[0][k] > 0.0 { shares[0][k] * (shares[0][k] / shares[1][k]).ln() } else { 0.0 };
        assert!((pair["by_need"][k].as_f64().unwrap() - by_hand).abs() < 1e-12, "need {k}");
        total += by_hand;
    }
    assert!((pair["distrust"].as_f64().unwrap() - total).abs() < 1e-12);
    assert!(
        (told["decision"]["score"]["Finite"].as_f64().unwrap() - total).abs() < 1e-12,
        "MaxOfBoth: the larger one"
    );
    let exchanges = told["robot"]["exchanges"].as_array().unwrap();
    assert_eq!(exchanges.len(), 1, "two robots of the role, one in each group");
}

#[test]
fn why_tells_in_sentences_and_names_what_it_cannot_find() {
    let folder = place();
    let here = folder.path();
    let text = succeeds(&usar(here, "why short.ron --seed 2 --robot 3 --at 30"));
    for part in [
        "round 1 began at 0.0 s, and RNE decided",
        "next best",
        "What drove it",
        "DIS: ",
        "Robot 3, carrier",
        "At 30.0 s it ",
    ] {
        assert!(text.contains(part), "{part:?} is not in:\n{text}");
    }
    let robots = "why short.ron --seed 2 --robot 3 --at 30 --set mission.decides=Robots()";
    let text = succeeds(&usar(here, robots));
    for part in [
        "and each robot decided by RNE: 66 of 66 pairs saw the same groups",
        "it saw the groups hard ",
        "It had heard of the others so long ago: 0: 0.0 s, 1: 0.0 s, 2: 0.0 s, 4: 0.0 s",
        "  0.0 s: it decides",
        "energy as it knew",
    ] {
        assert!(text.contains(part), "{part:?} is not in:\n{text}");
    }
    let forked =
        succeeds(&usar(here, "fork short.ron --round 1 --instead DIS --set mission.decides=Robots()"));
    assert!(forked.contains("DIS"), "{forked}");
    refused(here, 2, "why short.ron --round 99", &["--round: no round 99 began up to"]);
    refused(here, 2, "why short.ron --robot 99", &["--robot: must be below 12, found 99"]);
    refused(here, 2, "why short.ron --robot 1 --at 1e9", &["--at: must be from 0 to"]);
    refused(here, 2, "fork short.ron --round 99 --instead DIS", &["the trial is over before round 99"]);
    refused(here, 2, "oracle short.ron --metric luck", &["--metric: unknown metric \"luck\""]);
    refused(here, 2, "oracle short.ron --then LUCK", &["--then: unknown policy \"LUCK\""]);
}

#[test]
fn a_study_of_regret_goes_on_and_its_tables_agree_with_each_other() {
    let folder = place();
    let here = folder.path();
    let sweep = r#"(name: "small", scenario: "short.ron", policies: ["RNE", "DIS", "RANDOM"], trials: 3,
        set: {"team[0].count": 2, "team[1].count": 2, "duration_s": 200.0})"#;
    std::fs::write(here.join("small.ron"), sweep).unwrap();
    let whole = succeeds(&usar(here, "study regret small.ron --quiet --out whole --json"));
    succeeds(&usar(here, "study regret small.ron --quiet --out parts --trials 1"));
    let journal = here.join("parts/decisions.jsonl");
    let text = std::fs::read_to_string(&journal).unwrap();
    std::fs::write(&journal, &text[..text.len() - 9]).unwrap(); // as after a kill
    let parts = succeeds(&usar(here, "study regret small.ron --quiet --out parts --json"));
    assert_eq!(whole, parts);
    assert_eq!(
        std::fs::read(here.join("whole/regret.csv")).unwrap(),
        std::fs::read(here.join("parts/regret.csv")).unwrap()
    );
    let told: Value = serde_json::from_str(&whole).unwrap();
    let mut rows = csv::Reader::from_path(here.join("whole/regret.csv")).unwrap();
    let mut by_trial = std::collections::BTreeMap::<String, Vec<f64>>::new();
    for row in
        rows.records().map(Result::unwrap).filter(|row| &row[0] == "rescuees.total" && &row[5] == "DIS")
    {
        let [value, regret, best]: [f64; 3] = [7, 8, 9].map(|column: usize| row[column].parse().unwrap());
        assert!((best - value - regret).abs() < 1e-9);
        by_trial.entry(row[1].to_owned()).or_default().push(regret);
    }
    let means = by_trial.values().map(|regrets| regrets.iter().sum::<f64>() / regrets.len() as f64);
    let mean = means.sum::<f64>() / by_trial.len() as f64;
    let dis = &told["tables"]["analyses"][0]["policies"][1];
    assert_eq!(dis["policy"], "DIS");
    assert!((dis["regret"]["value"].as_f64().unwrap() - mean).abs() < 1e-9);
    refused(
        here,
        2,
        "study regret small.ron --out parts --limit 7",
        &["has the study of regret of something else", "limit: 1000 there, 7 now"],
    );
    refused(here, 2, "study regret short.ron --metric luck", &["--metric: unknown metric \"luck\""]);
}
