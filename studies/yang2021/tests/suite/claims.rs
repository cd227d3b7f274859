//! Tests of the paper's claims and readings, and of the pages about them.

use std::path::Path;

use experiments::comparison::short;
use experiments::sweep::folder::Folder;
use xtask::pages;
use yang2021::claims::{CLAIMS, judge};

use crate::support::{program, read, refuses as refused, root, succeeds, two_minutes, usar};

/// Checks the files that `usar yang2021 claims` writes.
fn has_the_files(results: &Path) {
    let authors = read(&root().join("scenarios/reference/dis_trials.csv"));
    for scenario in ["paper", "paper-calibrated"] {
        let columns = read(&results.join(format!("{scenario}.csv")));
        assert_eq!(columns.lines().next(), authors.lines().next(), "the authors' columns");
        assert_eq!(columns.lines().count(), 41);
        assert!(results.join(scenario).join("report.html").exists());
    }
    let rows = |name: &str| {
        let mut table = csv::Reader::from_path(results.join(name)).unwrap();
        table
            .deserialize::<std::collections::BTreeMap<String, String>>()
            .map(Result::unwrap)
            .collect::<Vec<_>>()
    };
    assert_eq!(
        rows("examples.csv").iter().map(|row| row["verdict"].as_str()).collect::<Vec<_>>(),
        ["holds", "holds", "does not hold"]
    );
    let predictions = rows("predictions.csv");
    let dis =
        predictions.iter().find(|row| row["policy"] == "DIS" && row["quantity"] == "rescuees_hard").unwrap();
    let trials = rows("paper.csv");
    let hard = trials
        .iter()
        .filter(|row| row["method"] == "DIS")
        .map(|row| row["rescuees_hard"].parse::<f64>().unwrap());
    let mean = hard.sum::<f64>() / 10.0;
    assert!((dis["mean"].parse::<f64>().unwrap() - mean).abs() < 1e-9, "{dis:?}");
    let claims = rows("claims.csv");
    let worlds =
        predictions.iter().map(|row| &row["scenario"]).collect::<std::collections::BTreeSet<_>>().len() - 1;
    assert!(worlds >= 2, "the printed one and the calibrated ones, and these together");
    assert_eq!(claims.len(), worlds * 2 * 30);
    for row in &claims {
        let bounds = ["low", "high", "shared_low", "shared_high"].map(|name| row[name].parse::<f64>().ok());
        let [Some(low), Some(high), Some(shared_low), Some(shared_high)] = bounds else {
            assert!(
                bounds == [None; 4] && row["difference"] == "0.0",
                "only the same has no interval: {row:?}"
            );
            continue;
        };
        assert!(shared_low <= low && low <= high && high <= shared_high, "{row:?}");
    }
}

/// Checks that the results of `usar yang2021 claims` for ten trials agree with its page and with the table
/// beside the page.
fn agrees_with_its_page(first: &str, results: &Path) {
    let of_ten = |path: &Path| -> Vec<csv::StringRecord> {
        let rows = csv::Reader::from_path(path).unwrap().into_records().map(Result::unwrap);
        rows.filter(|row| &row[1] == "10" && ["paper", "paper-calibrated"].contains(&&row[0])).collect()
    };
    let here = of_ten(&results.join("claims.csv"));
    let there = of_ten(&root().join("studies/yang2021/docs/reproduction/claims.csv"));
    // With ten trials in all, each comparison occurs twice: over the first ten, and over all.
    let here: Vec<_> = here.chunks(30).step_by(2).flatten().cloned().collect();
    assert_eq!(here.len(), 2 * 30);
    assert_eq!(here, there, "`just pages` makes studies/yang2021/docs/reproduction/claims.csv anew");
    let page = read(&root().join("studies/yang2021/docs/reproduction.md"));
    let verdicts = |text: &str, bar: char| -> Vec<[String; 3]> {
        let rows = text.lines().map(|line| {
            line.trim_matches(['│', '|']).split(bar).map(|cell| cell.trim().to_owned()).collect::<Vec<_>>()
        });
        let rows = rows.filter(|row| row.len() >= 5 && CLAIMS.iter().any(|claim| row[0] == claim.words));
        rows.map(|row| [0, 1, 3].map(|i| row[i].clone())).collect()
    };
    let printed = first.split("\nVerdicts\n").nth(1).unwrap_or_default();
    let told = page.split("| Verdicts -->\n").nth(1).unwrap_or_default();
    assert_eq!(verdicts(printed, '┆').len(), CLAIMS.len());
    assert_eq!(verdicts(printed, '┆'), verdicts(told, '|'));
}

/// Checks that the rows of the README's table are rows in the output of its first command.
fn agrees_with_the_readme(printed: &str) {
    let cells = |line: &str, bar: char| -> Vec<String> {
        line.split(bar).map(|cell| cell.trim_matches(['│', ' ']).to_owned()).collect()
    };
    let mut group = String::new();
    let mut rows = Vec::new();
    for mut row in printed.lines().filter(|line| line.starts_with('│')).map(|line| cells(line, '┆')) {
        if let Some(first) = row[0].strip_suffix(".total") {
            first.clone_into(&mut group);
        } else if [".hard", ".easy"].contains(&row[0].as_str()) {
            row[0] = format!("{group}{}", row[0]);
        }
        rows.push(row);
    }
    let readme = read(&root().join("README.md"));
    let told = readme.lines().filter(|line| line.starts_with('|') && line.contains('±'));
    let told: Vec<Vec<String>> = told.map(|line| cells(line.trim_matches(['|', ' ']), '|')).collect();
    assert_eq!(told.len(), 4);
    for row in told {
        assert!(rows.contains(&row), "README.md: {row:?} is not in\n{printed}");
    }
}

/// The claims over the paper's number of trials, and the pages in `docs/` with the numbers of these trials.
#[test]
fn the_papers_experiment_and_the_pages_that_tell_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["yang2021", "claims", "--trials", "10", "--out", "results/reproduction", "--quiet"];
    let first = succeeds(&usar(folder.path(), &arguments));
    assert_eq!(succeeds(&usar(folder.path(), &arguments)), first, "it is all there already");
    let results = folder.path().join("results/reproduction");
    has_the_files(&results);
    let report = read(&results.join("report.html"));
    assert_eq!(
        report.matches("<tr class=\"claim\">").count(),
        3 * 10,
        "the claims on both scenarios, and their ranges"
    );
    assert!(report.contains("Not said: it takes 50 trials, there are 10."));
    refused(
        &usar(folder.path(), "compare results/reproduction"),
        &["these in it are: results/reproduction/paper, results/reproduction/paper-calibrated"],
    );
    refused(
        &usar(folder.path(), "yang2021 claims --out results/reproduction/paper"),
        &["--out: results/reproduction/paper is the folder of one sweep"],
    );
    let example = |n: &str, verdict: &str| {
        let line = first.lines().find(|line| line.contains(n)).unwrap_or_default();
        assert!(line.contains(verdict), "{line}");
    };
    example("Example 2", "┆ holds");
    example("Example 3", "┆ does not hold");

    agrees_with_its_page(&first, &results);

    // The table of the README agrees as well.
    let sweep = root().join("scenarios/paper.ron");
    let sweep = ["sweep", sweep.to_str().unwrap(), "--out", "results/reproduction/paper", "--quiet"];
    agrees_with_the_readme(&succeeds(&usar(folder.path(), &sweep)));

    // The page studies/yang2021/docs/why.md has the numbers of the paper's ten trials.
    let page = read(&root().join("studies/yang2021/docs/why.md"));
    let mut found = 0;
    let renewed = pages::renewed(&page, |command| {
        let options = command.strip_prefix("yang2021 sorting results/paper ")?;
        found += 1;
        Some(pages::answer(
            program(),
            folder.path(),
            &format!("yang2021 sorting results/reproduction/paper {options}"),
        ))
    });
    assert!(found > 1, "studies/yang2021/docs/why.md has that command");
    assert_eq!(
        renewed.page, page,
        "studies/yang2021/docs/why.md is not what `usar yang2021 sorting results/paper` prints: `just pages`"
    );
    for (name, text) in &renewed.files {
        assert_eq!(
            &read(&root().join("studies/yang2021/docs").join(name)),
            text,
            "{name}: `just pages` makes it anew"
        );
    }
}

/// The sums of a policy's costs and rescuees of a task, from `trials.csv`, as a ratio.
fn ratio(results: &Path, policy: &str, task: &str) -> f64 {
    let mut table = csv::Reader::from_path(results.join("trials.csv")).unwrap();
    let header = table.headers().unwrap().clone();
    let place = |name: &str| header.iter().position(|known| known == name).unwrap();
    let [energy, rescuees] = ["energy", "rescuees"].map(|name| place(&format!("{name}_{task}")));
    let rows: Vec<_> = table.records().map(Result::unwrap).filter(|row| &row[0] == policy).collect();
    let sum = |column: usize| rows.iter().map(|row| row[column].parse::<f64>().unwrap()).sum::<f64>();
    sum(energy) / sum(rescuees)
}

/// Where trials have few rescuees or none, each command compares the ratios of sums of the same trials.
#[test]
fn all_commands_agree_on_a_cost_per_rescuee() {
    let place = two_minutes();
    let folder = place.path();
    let sweep =
        "(name: \"few\", scenario: \"short.ron\", set: {\"duration_s\": 81.0}, keep: Trials, trials: 20,
        policies: [\"RNE\", \"DIS\", \"ENG\", \"HP_DIS\"], primary: [\"energy_per_rescuee.hard\"],
        baseline: \"DIS\", expect: [\"energy_per_rescuee.hard: RNE > DIS\"])";
    std::fs::write(folder.join("few.ron"), sweep).unwrap();
    let told = succeeds(&usar(folder, "sweep few.ron --quiet"));
    let results = folder.join("results/few");
    let [rne, dis] = ["RNE", "DIS"].map(|policy| ratio(&results, policy, "hard"));
    assert!(told.contains(&format!("{} ±", short(rne))), "{rne}: {told}");
    let is = |found: Option<f64>, expected: f64| (found.unwrap() - expected).abs() < 1e-9;
    let json = |output: Vec<u8>| -> serde_json::Value { serde_json::from_slice(&output).unwrap() };
    let compared = json(succeeds(&usar(folder, "compare results/few --json")).into_bytes());
    let compared = &compared["tables"]["comparisons"][0];
    assert_eq!(
        (&compared["a"], &compared["n"], &compared["is_of_sums"]),
        (&"RNE".into(), &20.into(), &true.into())
    );
    assert!(is(compared["difference"].as_f64(), rne - dis), "{compared}");
    let tested = json(usar(folder, "test few.ron --max-trials 20 --quiet --json").stdout);
    let tested = &tested["tables"]["expectations"][0];
    assert!(tested["n"] == 20 && is(tested["observed"].as_f64(), rne - dis), "{tested}");
    let is_clear = |interval: &serde_json::Value, sign: f64| {
        (0..2).all(|end| interval[end].as_f64().is_some_and(|end| end * sign > 0.0))
    };
    let holds = is_clear(&tested["interval"], 1.0);
    assert_eq!(tested["verdict"] == "holds", holds, "{tested}");
    assert!(!holds || compared["verdict"] == "worse", "the cautious interval is the wider one: {compared}");
    succeeds(&usar(folder, "report results/few"));
    let page = read(&results.join("report.html"));
    assert!(page.contains(&short((rne - dis).abs())) && page.contains(&short(rne)), "{rne} {dis}");
    let folder = Folder::read(&results, &policies::standard()).unwrap();
    let found = |claim: &str| {
        let claim = CLAIMS.iter().find(|known| known.name == claim).unwrap();
        judge(&folder, claim, 20).unwrap().parts.swap_remove(0)
    };
    let [policies, tasks] = ["energy, hard", "dearer energy"].map(found);
    assert!(policies.n == 20 && is(policies.difference, rne - dis), "{policies:?}");
    assert!(tasks.n == 20 && is(tasks.difference, rne - ratio(&results, "RNE", "easy")), "{tasks:?}");
    let ends = [0, 1].map(|end| compared["interval"][end].as_f64().unwrap());
    assert_eq!(policies.interval, Some(ends), "one interval");
}

#[test]
fn readings_stand_for_every_combination_and_are_named_by_what_differs() {
    let place = two_minutes();
    let folder = place.path();
    let sweep = |readings: &str, policies: &str| {
        let text = format!(
            "(name: \"r\", scenario: \"short.ron\", set: {{\"duration_s\": 30.0}}, policies: {policies}, \
             readings: {readings}, trials: 2, keep: Rounds)"
        );
        std::fs::write(folder.join("r.ron"), text).unwrap();
        usar(folder, "sweep r.ron --quiet --out out --fresh")
    };
    succeeds(&sweep(
        "{\"hard_rule\": [IntraGroupTrust, MeanHp], \"log_base\": [E, Two]}",
        "[\"RNE\", \"DIS\"]",
    ));
    let labels: Vec<String> = csv::Reader::from_path(folder.join("out/trials.csv"))
        .unwrap()
        .records()
        .map(|record| record.unwrap()[0].to_owned())
        .collect();
    let names = [
        "RNE",
        "RNE(log_base: Two)",
        "RNE(hard_rule: MeanHp)",
        "RNE(hard_rule: MeanHp, log_base: Two)",
        "DIS",
    ];
    assert_eq!(labels, names.map(|name| [name, name]).concat());
    assert!(!folder.join("out/hashes.csv").exists() && !folder.join("out/groups.csv").exists(), "it is lean");
    assert!(succeeds(&usar(folder, "verify out")).starts_with("10 of 10 trials match"));
    let table = succeeds(&usar(folder, "yang2021 readings out"));
    let base = table.lines().find(|line| line.contains("log_base: Two")).unwrap();
    assert!(base.matches(" 0.0 %").count() == 3, "the base of the logarithm decides nothing: {base}");
    assert!(table.contains("The 2 of 4 readings whose trials differ, against each other policy"), "{table}");
    let by_hp = table.lines().find(|line| line.contains("hard_rule: MeanHp")).unwrap();
    assert!(
        by_hp.matches(" 0.0 %").count() < 3 && !by_hp.contains("-nan"),
        "the hard rule decides something: {by_hp}"
    );
    let set = |more: &[&str]| usar(folder, &[&["sweep", "r.ron", "--quiet", "--out", "new"], more].concat());
    refused(&set(&["--policies", "DIS,ENG"]), &["this sweep does not run RNE. Add it to `policies`."]);
    assert!(!folder.join("new").exists());
    refused(
        &sweep("{\"hard_rule\": [MeanHp, MeanHp]}", "[\"RNE\"]"),
        &["must not be listed twice", "MeanHp"],
    );
    refused(&sweep("{\"wings\": [MeanHp]}", "[\"RNE\"]"), &["readings.\"wings\"[0]: policy RNE: ", "wings"]);
    refused(&sweep("{\"sort\": []}", "[\"RNE\"]"), &["must have at least one value"]);
    refused(
        &sweep("{\"sort\": [true]}", "[\"DIS\"]"),
        &["this sweep does not run RNE. Add it to `policies`."],
    );
}

/// A page can select one table of a command, one paragraph, or a table as a file beside it.
#[test]
fn a_page_takes_parts_of_what_a_command_prints() {
    let page = "\
<!-- $ usar x | Second -->
| old |
| --- |
After.
<!-- $ usar x | Note -->
```text
old
```
<!-- $ usar x | 1 > first.csv -->
<!-- $ usar y -->
```text
stays
```
";
    let answer = "First\n\n| a | b |\n| --- | --- |\n| 1, 2 | x\\|y |\n\nSecond one\n\n| c |\n| --- |\n| 3 \
        |\n\nNote: so\nit is\n\nno more\n";
    let renewed = pages::renewed(page, |command| command.starts_with("x ").then(|| answer.to_owned()));
    let expected = page.replacen("| old |\n| --- |", "| c |\n| --- |\n| 3 |", 1);
    let expected = expected.replacen("```text\nold\n", "```text\nNote: so\nit is\n", 1);
    assert_eq!(renewed.page, expected);
    assert_eq!(renewed.files, [("first.csv".to_owned(), "a,b\n\"1, 2\",x|y\n".to_owned())]);
}
