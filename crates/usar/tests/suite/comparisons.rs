//! Analyses of a sweep: comparisons, precision, and cost estimates.

use serde_json::Value;

use crate::place::{column, place, refused, rows};
use crate::support::{succeeds, usar};

#[test]
fn comparisons_are_paired_and_say_what_they_stand_on() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, "sweep short.ron --policies RNE,DIS,ENG --trials 6 --set duration_s=85"));
    let json: Value = serde_json::from_str(&succeeds(&usar(
        here,
        "compare results/paper --metric distance --metric rescuees.hard --baseline DIS --json",
    )))
    .unwrap();
    assert_eq!(json["version"], 2);
    let comparisons = json["tables"]["comparisons"].as_array().unwrap();
    assert_eq!(comparisons.len(), 4);
    let trials = rows(&here.join("results/paper"), "trials.csv");
    let distance = column(&here.join("results/paper"), "distance_m");
    let distances = |policy: &str| -> Vec<f64> {
        trials.iter().filter(|row| &row[0] == policy).map(|row| row[distance].parse().unwrap()).collect()
    };
    let (rne, dis) = (distances("RNE"), distances("DIS"));
    let mean = rne.iter().zip(&dis).map(|(a, b)| a - b).sum::<f64>() / 6.0;
    assert_eq!(
        (&comparisons[0]["a"], &comparisons[0]["b"], &comparisons[0]["n"]),
        (&"RNE".into(), &"DIS".into(), &6.into())
    );
    assert!((comparisons[0]["difference"].as_f64().unwrap() - mean).abs() < 1e-9);
    let variance = |values: &[f64]| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (values.len() - 1) as f64
    };
    let differences: Vec<f64> = rne.iter().zip(&dis).map(|(a, b)| a - b).collect();
    let pairing = (variance(&rne) + variance(&dis)) / variance(&differences);
    assert!((comparisons[0]["pairing"].as_f64().unwrap() / pairing - 1.0).abs() < 1e-9);
    let [low, high] = [0, 1].map(|i: usize| comparisons[0]["interval"][i].as_f64().unwrap());
    assert!(low <= mean && mean <= high);
    let text = succeeds(&usar(here, "compare results/paper"));
    let same = "rescuees.easy: RNE the same as DIS, RNE the same as ENG.";
    assert!(text.starts_with(same) && text.contains("Holm's correction over 4 comparisons"), "{text}");
    assert!(text.lines().all(|line| !line.contains('│') || line.chars().count() <= 80), "{text}");
    let wide = succeeds(&usar(here, "compare results/paper --wide"));
    assert!(wide.contains("┆ detectable ┆") && !text.contains("detectable"), "{wide}");
    let all = succeeds(&usar(here, "compare results/paper --metric all --json"));
    let all: Value = serde_json::from_str(&all).unwrap();
    assert!(
        all["tables"]["comparisons"].as_array().unwrap().len() > 100,
        "every metric, every pair of policies"
    );
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    assert_eq!(text, succeeds(&usar(here, "compare results/paper")), "the bootstrap is seeded");
    refused(
        here,
        2,
        "compare results/paper --metric luck",
        &["unknown metric \"luck\"; known metrics: rescuees.total"],
    );
    refused(
        here,
        2,
        "compare results/paper --baseline RANDOM",
        &["must be a policy of the sweep (RNE, DIS, ENG)"],
    );
    refused(
        here,
        2,
        "compare results/paper --policies RNE,RANDOM",
        &["--policies: must be a policy of the sweep (RNE, DIS, ENG), found \"RANDOM\""],
    );
    refused(here, 2, "compare results/paper --policies RNE", &["nothing to compare: RNE only"]);
    let two = ["compare", "results/paper", "--policies", "ENG, RNE", "--metric", "rescuees.hard"];
    let two = succeeds(&usar(here, &two));
    assert!(two.contains("│ RNE - ENG ┆") && !two.contains("DIS -"), "{two}");
    // A narrower question has the same sign, and says how it differs.
    let narrow = succeeds(&usar(here, "compare results/paper --metric rescuees.hard --baseline ENG"));
    assert!(narrow.contains("│ RNE - ENG ┆") && narrow.contains("│ DIS - ENG ┆"), "{narrow}");
    let own = "The folder's own question, that is asked by default, has 6 comparisons.";
    assert!(narrow.contains(own) && !text.contains("own question"), "{narrow}");
    refused(here, 2, "compare results", &["results: is not the folder of a sweep"]);
}

#[test]
fn trials_are_added_until_the_difference_is_known_well_enough() {
    let folder = place();
    let here = folder.path();
    let sweep = |bound: &str, most: &str| {
        let rule = format!("distance: RNE-DIS: {bound}");
        let arguments =
            ["sweep", "short.ron", "--policies", "RNE,DIS", "--precision", &rule, "--max-trials", most];
        succeeds(&usar(here, &arguments))
    };
    let wide = sweep("1000", "100");
    assert!(wide.contains("precision reached") && wide.contains("(20 pairs"), "{wide}");
    let narrow = sweep("0.001", "25");
    assert!(narrow.contains("precision NOT reached") && narrow.contains("after 25 pairs"), "{narrow}");
    assert_eq!(rows(&here.join("results/paper"), "trials.csv").len(), 50);
    refused(
        here,
        2,
        &["sweep", "short.ron", "--precision", "distance: RNE: 2"],
        &["A and B must be two policies"],
    );
    refused(here, 2, &["sweep", "short.ron", "--precision", "distance: RNE-DIS: 0"], &["a number above 0"]);
}

#[test]
fn a_rule_of_precision_can_be_given_again_and_needs_pairs_that_differ() {
    let folder = place();
    let here = folder.path();
    let sweep = |metric: &str| {
        let rule = format!("{metric}: RNE-DIS: 0.001");
        let arguments = ["sweep", "short.ron", "--policies", "RNE,DIS", "--trials", "20"];
        succeeds(&usar(here, &[&arguments[..], &["--precision", &rule, "--max-trials", "25"]].concat()))
    };
    let first = sweep("distance");
    assert!(first.contains("after 25 pairs"), "{first}");
    assert_eq!(first, sweep("distance"), "the same command again");
    // No rescuee is delivered within half a minute: all pairs are equal.
    let none = sweep("rescuees.hard");
    assert!(none.contains("NOT reached: there are too few pairs"), "{none}");
    let listed =
        std::fs::read_to_string(here.join("grid.ron")).unwrap().replace("trials: 2", "seeds: [5, 6, 9]");
    std::fs::write(here.join("listed.ron"), listed).unwrap();
    let rule = ["--precision", "distance: RNE-DIS: 0.001", "--out", "results/listed"];
    let said = succeeds(&usar(here, &[&["sweep", "listed.ron"], &rule[..]].concat()));
    assert!(said.contains("after 3 pairs"), "{said}");
}

#[test]
fn a_sweep_file_names_its_metrics_its_baseline_and_which_differences_matter() {
    let folder = place();
    let here = folder.path();
    let sweep = |rest: &str| {
        let text = format!(
            "(name: \"asked\", scenario: \"short.ron\", policies: [\"RNE\", \"DIS\", \"ENG\"], trials: 6, \
             {rest})"
        );
        std::fs::write(here.join("asked.ron"), text).unwrap();
    };
    sweep("primary: [\"distance\"], baseline: \"DIS\", margins: {\"distance\": 1e6}");
    succeeds(&usar(here, "sweep asked.ron --quiet"));
    let json = |rest: &[&str]| -> Value {
        let arguments = [&["compare", "results/asked", "--json"], rest].concat();
        serde_json::from_str(&succeeds(&usar(here, &arguments))).unwrap()
    };
    let told = json(&[]);
    let comparisons = told["tables"]["comparisons"].as_array().unwrap();
    let pairs: Vec<_> =
        comparisons.iter().map(|c| (c["a"].as_str().unwrap(), c["b"].as_str().unwrap())).collect();
    assert_eq!(pairs, [("RNE", "DIS"), ("ENG", "DIS")]);
    for comparison in comparisons {
        assert_eq!(
            (comparison["metric"].as_str(), &comparison["judged"]["margin"]),
            (Some("distance"), &1e6.into())
        );
        assert_eq!(comparison["verdict"], "equivalent");
        let [low, high] = [0, 1].map(|i: usize| comparison["judged"]["interval_90"][i].as_f64().unwrap());
        let [lower, higher] = [0, 1].map(|i: usize| comparison["interval"][i].as_f64().unwrap());
        assert!(lower <= low && high <= higher, "the 90 % interval lies in the 95 % interval");
        assert!(comparison["in_words"].as_str().unwrap().contains("are equivalent within 1000000"));
    }
    let told = succeeds(&usar(here, "compare results/asked"));
    assert!(told.contains("Margins: distance 1000000 (sweep file)."), "{told}");
    let told = succeeds(&usar(here, "compare results/asked --margin distance=2e6"));
    assert!(told.contains("Margins: distance 2000000 (--margin)."), "{told}");
    // The sweep file in the folder asks the same.
    succeeds(&usar(&here.join("results/asked"), &["sweep", "sweep.ron", "--out", "again", "--quiet"]));
    let [asked, again] =
        ["results/asked", "results/asked/again"].map(|folder| succeeds(&usar(here, &["compare", folder])));
    assert_eq!(asked, again);
    refused(
        here,
        2,
        "compare results/asked --margin waiting=1",
        &["--margin: waiting is not compared here; --metric waiting compares it"],
    );
    refused(
        here,
        2,
        "compare results/asked --margin distance=1 --margin distance=2",
        &["--margin: distance has two margins"],
    );
    let tight = json(&["--metric", "distance", "--baseline", "ENG", "--margin", "distance=1e-9"]);
    let verdicts: Vec<_> = tight["tables"]["comparisons"]
        .as_array()
        .unwrap()
        .iter()
        .map(|c| c["verdict"].as_str().unwrap())
        .collect();
    assert_eq!(verdicts, ["undecided"; 2], "six pairs decide nothing");
    refused(
        here,
        2,
        "compare results/asked --margin distance=0",
        &["must be METRIC=VALUE with a value above 0"],
    );
    refused(here, 2, "compare results/asked --margin luck=1", &["--margin: unknown metric \"luck\""]);
    refused(
        here,
        2,
        "compare results/asked --policies ENG --margin distance=1",
        &["--margin: a margin is for the difference of two policies, and ENG is the only one here"],
    );
    sweep("primary: [\"luck\"]");
    refused(here, 2, "sweep asked.ron", &["asked.ron:1: primary[0]: unknown metric \"luck\""]);
    sweep("margins: {\"distance\": -1}");
    refused(
        here,
        2,
        "sweep asked.ron",
        &["asked.ron:1: margins.\"distance\": must be a number above 0, found -1"],
    );
}

#[test]
fn a_sweep_with_axes_says_how_differences_change_along_them() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, "sweep grid.ron --set duration_s=120 --trials 6 --quiet"));
    let told = succeeds(&usar(here, "compare results/grid --metric distance --baseline DIS --json"));
    let told: Value = serde_json::from_str(&told).unwrap();
    let words = succeeds(&usar(here, "compare results/grid --metric distance --baseline DIS"));
    let cases = words.lines().filter(|line| line.starts_with('│')).count() - 1;
    assert_eq!(cases, 4, "a table of cases: {words}");
    assert!(words.contains("changes of means: none can be shown, however large"), "{words}");
    let interactions = told["tables"]["interactions"].as_array().unwrap();
    // Two axes of two values: each value but the first, at both values of the other axis, for each policy
    // but the baseline.
    let policies = told["tables"]["comparisons"].as_array().unwrap().len() / 4;
    assert_eq!(interactions.len(), 4 * policies);
    let results = here.join("results/grid");
    let (trials, at) = (rows(&results, "trials.csv"), column(&results, "distance_m"));
    let header = csv::Reader::from_path(results.join("trials.csv")).unwrap().headers().unwrap().clone();
    let [case, method, trial] =
        ["case", "method", "trial"].map(|name| header.iter().position(|h| h == name).unwrap());
    let value = |number: &str, policy: &str, number_of: usize| -> f64 {
        let is_it = |row: &&csv::StringRecord| {
            row[case] == *number && &row[method] == policy && row[trial] == number_of.to_string()
        };
        trials.iter().find(is_it).unwrap()[at].parse().unwrap()
    };
    let effects = told["tables"]["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 4 * (policies + 1), "the baseline, too");
    for one in effects {
        let policy = one["policy"].as_str().unwrap();
        let at = |at: &str, trial| value(&one[at].to_string(), policy, trial);
        let change = (1..=6).map(|trial| at("case", trial) - at("reference", trial)).sum::<f64>() / 6.0;
        assert!((one["change"].as_f64().unwrap() - change).abs() < 1e-6, "{one}");
        let means = one["means"].as_array().unwrap();
        assert!((means[1].as_f64().unwrap() - means[0].as_f64().unwrap() - change).abs() < 1e-6, "{one}");
    }
    for one in interactions {
        let (a, b) = (one["a"].as_str().unwrap(), one["b"].as_str().unwrap());
        let difference =
            |at: &str, trial| value(&one[at].to_string(), a, trial) - value(&one[at].to_string(), b, trial);
        let change =
            (1..=6).map(|trial| difference("case", trial) - difference("reference", trial)).sum::<f64>()
                / 6.0;
        assert!((one["change"].as_f64().unwrap() - change).abs() < 1e-6, "{one}");
        assert!(one["in_words"].as_str().unwrap().contains(&format!("{a} less {b} goes from")), "{one}");
    }
    let printed = succeeds(&usar(here, "compare results/grid --metric distance --baseline DIS --wide"));
    let table = |title: &str| -> usize {
        let rest = printed.split_once(title).unwrap_or_else(|| panic!("{title}\n{printed}")).1;
        let rows = rest.lines().skip(2).take_while(|line| !line.starts_with('└'));
        rows.filter(|line| line.starts_with('│')).count() - 1
    };
    assert_eq!(table("By how much each policy's mean changes"), 4, "a row for each change");
    assert_eq!(table("Differences between policies, case by case"), 4, "a row for each case");
    assert_eq!(table("By how much these differences change"), 4);
}

#[test]
fn one_policy_is_compared_with_itself_along_an_axis() {
    let folder = place();
    let here = folder.path();
    let sweep = "(name: \"one\", scenario: \"short.ron\", policies: [\"ENG\"], trials: 3, \
                 axes: {\"mission.rest_s\": [30.0, 5.0]})";
    std::fs::write(here.join("one.ron"), sweep).unwrap();
    succeeds(&usar(here, "sweep one.ron --set duration_s=120"));
    let told = succeeds(&usar(here, "compare results/one --metric distance"));
    let line = |text: &str| told.lines().find(|line| line.contains(text)).unwrap_or_else(|| panic!("{told}"));
    let (means, change) = (line("mean, mission.rest_s = 30"), line("mission.rest_s from 30"));
    assert!(!means.contains('%') && change.contains(" %"), "{told}");
    assert!(!told.contains("Differences between policies"), "{told}");
    let program = succeeds(&usar(here, "compare results/one --metric distance --json"));
    let program: Value = serde_json::from_str(&program).unwrap();
    let mean = program["tables"]["effects"][0]["means"][0].as_f64().unwrap();
    let shown: f64 = means.split('┆').nth(1).unwrap().trim().trim_end_matches('│').trim().parse().unwrap();
    assert!((mean - shown).abs() < 0.01 * mean, "{mean} {means}");
}

/// Where nothing is drawn, every seed is the same trial: twenty of them say no more than one.
#[test]
fn trials_that_repeat_one_another_count_once() {
    let folder = place();
    let here = folder.path();
    let scenario = "(name: \"fixed\", duration_s: 60.0, dt_s: 0.02, arena_m: (40.0, 30.0), \
        team: [(role: \"robot\", count: 2, center: (15.0, 3.0), width_m: 4.0, levels: (energy: 90, hp: 90)), \
        (role: \"robot\", count: 2, center: (25.0, 3.0), width_m: 4.0, levels: (energy: 50, hp: 100))], \
        tasks: [(name: \"hard\", difficulty: 2, center: (10.0, 20.0), size_m: (4.0, 4.0), grid: (4, 4), \
        rest: (6.0, 9.0)), (name: \"easy\", difficulty: 1, center: (30.0, 14.0), size_m: (4.0, 4.0), \
        grid: (4, 4), rest: (34.0, 9.0))])";
    std::fs::write(here.join("fixed.ron"), scenario).unwrap();
    succeeds(&usar(here, "sweep fixed.ron --policies DIS,ENG --trials 20 --quiet"));
    let told = succeeds(&usar(here, "compare results/fixed --metric energy"));
    assert!(told.starts_with("energy.total: DIS the same as ENG."), "{told}");
    assert!(told.contains("19 that repeat another to the last state"), "{told}");
    let json = succeeds(&usar(here, "compare results/fixed --metric energy --json"));
    let one = &serde_json::from_str::<Value>(&json).unwrap()["tables"]["comparisons"][0];
    assert_eq!((&one["n"], &one["repeated"], &one["p"]), (&1.into(), &19.into(), &Value::Null));
    assert_eq!(one["verdict"], "same");
}
