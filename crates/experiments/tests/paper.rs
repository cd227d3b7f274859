//! The paper put to the test: calibration, claims, readings, and the pages that tell of them.

mod pages;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::AtomicBool;

use experiments::calibration::{Calibration, Free, Log, Spread, Target};
use experiments::metric::metric_named;
use experiments::readings::{Trials, rivals};
use experiments::sweep::folder::Folder;
use statrs::distribution::{ContinuousCDF, StudentsT};
use usar_sim::scenario::{Fields, Scenario};

fn program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_usar"))
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap().to_owned()
}

fn usar(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(program()).args(arguments).current_dir(folder).output().expect("usar runs")
}

#[track_caller]
fn succeeds(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout.clone()).unwrap()
}

#[track_caller]
fn refused(output: &Output, messages: &[&str]) {
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    for message in messages {
        assert!(stderr.contains(message), "must say {message:?}, said {stderr:?}");
    }
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A folder with the paper's scenario for two minutes, and a target for it.
fn place() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let text = read(&root().join("scenarios/paper.ron")).replace("duration_s: 600.0", "duration_s: 120.0");
    std::fs::write(folder.path().join("short.ron"), text).unwrap();
    let target = "method,rescuees_hard,energy_hard\nDIS,10,150\nDIS,14,160\nDIS,12,170\n";
    std::fs::write(folder.path().join("target.csv"), target).unwrap();
    folder
}

fn calibrate<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut arguments = vec!["calibrate", "short.ron", "--target", "target.csv", "--trials", "2"];
    arguments.extend(["--fresh-trials", "2", "--quiet", "--out", out]);
    arguments.extend(["--free", "roles.carrier.speed_mps + roles.supplier.speed_mps=1..4"]);
    arguments.extend([
        "--free",
        "radiation[*].radius_m = 2..6",
        "--free",
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
    let log = folder.join("parts/evaluations.csv");
    let text = read(&log);
    std::fs::write(&log, &text[..text.len() - 5]).unwrap(); // killed while it wrote a line
    let parts = succeeds(&usar(folder, &calibrate("parts", &["--evaluations", "8", "--jobs", "2"])));
    assert_eq!(parts, whole);
    for file in ["evaluations.csv", "calibrated.ron", "fit.csv", "calibration.json"] {
        assert_eq!(read(&folder.join("parts").join(file)), read(&folder.join("whole").join(file)), "{file}");
    }
    let (scenario, text) = Scenario::load(&folder.join("whole/calibrated.ron")).unwrap();
    assert_eq!(scenario.name, "paper-fitted");
    assert!(text.starts_with("// Fitted by usar calibrate (misfit "), "{text}");
    assert!(text.contains("// Places [view]"), "comments stay");
    assert_eq!(scenario.roles.carrier.speed_mps.to_bits(), scenario.roles.supplier.speed_mps.to_bits());
    assert!(
        scenario
            .radiation
            .iter()
            .all(|zone| zone.radius_m.to_bits() == scenario.radiation[0].radius_m.to_bits())
    );
    assert!(whole.contains("roles.carrier.speed_mps = ") && whole.contains("rescuees_hard"), "{whole}");
}

#[test]
fn what_cannot_be_calibrated_is_refused() {
    let place = place();
    let folder = place.path();
    let run = |more: &[&str]| usar(folder, &calibrate("out", more));
    refused(
        &run(&["--free", "roles.carrier.wings=1..2"]),
        &["--free: roles.carrier.wings: no such field; roles.carrier has radius_m"],
    );
    refused(
        &run(&["--free", "roles.carrier.capacity=2..8"]),
        &["--free: roles.carrier.capacity: takes whole numbers only"],
    );
    refused(&run(&["--free", "duration_s=60..90"]), &["--free: duration_s: is that of the recorded trials"]);
    refused(&run(&["--set", "radiation[0].radius_m=3.0"]), &["--set: radiation[0].radius_m is free"]);
    refused(
        &run(&["--free", "mission.health_floor=0..1"]),
        &["--free: mission.health_floor must be a number from", "found 0"],
    );
    refused(&run(&["--free", "radiation[0].radius_m=2..3"]), &["radiation[0].radius_m: is set twice"]);
    refused(
        &run(&["--set", "mission.loading_s=1.0", "--set", "mission.loading_s=2.0"]),
        &["--set: mission.loading_s: is set twice"],
    );
    refused(&run(&["--first-seed", "2"]), &["--first-seed: must be beyond the fresh trials", "found 2"]);
    refused(&run(&["--set", "mission.wings=1"]), &["--set: mission.wings: no such field; mission has"]);
    std::fs::write(folder.join("target.csv"), "method,rounds\nDIS,6\nRNE,7\n").unwrap();
    refused(&run(&[]), &["target.csv:3: method must be DIS", "\"RNE\""]);
    let targets = [
        (
            "method,rescued_hard,rounds\nDIS,6,6\n",
            "target.csv:1: \"rescued_hard\" is no column of trials.csv",
        ),
        (
            "method,rounds\r\nDIS,6\r\nDIS,six\r\n",
            "target.csv:3: rounds must be a number from 0 on, found \"six\"",
        ),
        ("method,rounds\nDIS,-1\nDIS,7\n", "target.csv:2: rounds must be a number from 0 on, found \"-1\""),
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
            "target.csv:2: rescuees_total must be a number from 0 on",
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
        &run(&["--evaluations", "2", "--seed", "9"]),
        &["has the calibration of something else", "seed: 1 there, 9 now"],
    );
    std::fs::write(folder.join("target.csv"), "method,rounds\nDIS,6\nDIS,8\n").unwrap();
    refused(&run(&["--evaluations", "2"]), &["target.rounds: [6.5,0.70", "there, [7.0,1.41"]);
    std::fs::write(folder.join("target.csv"), "method,rounds\nDIS,6\nDIS,7\n").unwrap();
    refused(
        &run(&["--evaluations", "2", "--set", "mission.loading_s=3.0"]),
        &["mission.loading_s: 2.0 there, 3.0 now"],
    );
}

/// `rivals` counts by intervals: here they are made once more, from the differences.
#[test]
fn readings_are_counted_against_each_rival_and_against_all() {
    let place = place();
    let folder = place.path();
    let text = "(name: \"r\", scenario: \"short.ron\", set: {\"duration_s\": 300.0}, policies: [\"RNE\", \"DIS\", \"HP_DIS\"],
        readings: {\"hard_rule\": [IntraGroupTrust, MeanHp], \"merge\": [Apart, Together]}, trials: 8, lean: true)";
    std::fs::write(folder.join("r.ron"), text).unwrap();
    succeeds(&usar(folder, &["sweep", "r.ron", "--quiet", "--out", "out"]));
    let sweep = Folder::read(&folder.join("out")).unwrap();
    let rows = rivals(&Trials::of(&sweep), &[0, 1, 2, 3]);
    let sides = |metric: &str, rival: usize, tail: f64| -> Vec<i32> {
        let metric = metric_named(metric).unwrap();
        let value = |policy: usize, trial: u32| {
            sweep.results()[&(0, policy, trial)].metrics.as_ref().unwrap()[metric].unwrap()
        };
        let t = StudentsT::new(0.0, 1.0, 7.0).unwrap().inverse_cdf(1.0 - tail);
        let side = |reading: usize| {
            let differences: Vec<f64> =
                (1..=8).map(|trial| value(reading, trial) - value(rival, trial)).collect();
            let mean = differences.iter().sum::<f64>() / 8.0;
            let variance = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / 7.0;
            let half = t * (variance / 8.0).sqrt();
            i32::from(mean - half > 0.0) - i32::from(mean + half < 0.0)
        };
        (0..4).map(side).collect()
    };
    let count = |sides: &[i32], side: i32| sides.iter().filter(|found| **found == side).count();
    let mut decided = 0;
    for row in &rows {
        let both = |tail: f64| [4, 5].map(|rival| sides(row.metric, rival, tail));
        let [own, shared] = [0.025, 0.025 / 4.0].map(|tail| match row.rival.as_deref() {
            Some("DIS") => both(tail)[0].clone(),
            Some(_) => both(tail)[1].clone(),
            None => {
                both(tail)[0].iter().zip(&both(tail)[1]).map(|(a, b)| if a == b { *a } else { 0 }).collect()
            }
        });
        assert_eq!(row.counts, [1, -1, 0].map(|side| count(&own, side)), "{} {:?}", row.metric, row.rival);
        assert_eq!(row.corrected, [1, -1].map(|side| count(&shared, side)), "{} {:?}", row.metric, row.rival);
        decided += row.counts[0] + row.counts[1];
    }
    assert_eq!(rows.len(), 4 * 3);
    assert!(decided > 0, "nothing to count");
}

#[test]
fn a_search_begins_within_its_ranges() {
    let place = place();
    let folder = place.path();
    let mut arguments =
        calibrate("out", &["--free", "costs.energy.per_metre=0.1..0.2 log", "--evaluations", "1"]);
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
    let log = read(&folder.join("out/evaluations.csv"));
    let mut log = csv::Reader::from_reader(log.as_bytes());
    let place = log.headers().unwrap().iter().position(|name| name == "costs.energy.per_metre").unwrap();
    for row in log.records() {
        let value: f64 = row.unwrap()[place].parse().unwrap();
        assert!((0.1..=0.2).contains(&value), "{value}");
    }
}

/// The command that made `paper-calibrated.ron` has its log in `docs/calibration/`; its best candidate is the scenario, and running it again gives the
/// numbers of the log.
#[test]
fn the_calibrated_scenario_is_the_best_of_its_log() {
    let (scenario, text) = Scenario::load(&root().join("scenarios/paper-calibrated.ron")).unwrap();
    let fields = Fields::of(&text);
    let log = read(&root().join("docs/calibration/chosen.csv"));
    let mut rows = csv::Reader::from_reader(log.as_bytes());
    let header = rows.headers().unwrap().clone();
    let records: Vec<csv::StringRecord> = rows.records().map(Result::unwrap).collect();
    let misfit = |record: &csv::StringRecord| record[1].parse::<f64>().unwrap();
    let best = records.iter().min_by(|a, b| misfit(a).total_cmp(&misfit(b))).unwrap();
    let names = || header.iter().zip(best).filter(|(name, _)| name.contains('.'));
    assert!(names().count() >= 5, "{header:?}");
    for (name, value) in names() {
        let path = name.replace("[*]", "[0]");
        let written = text[fields.value(&path).unwrap()].trim().parse::<f64>().unwrap();
        assert_eq!(written.to_bits(), value.parse::<f64>().unwrap().to_bits(), "{path}");
    }
    let target = Target::load(&root().join("scenarios/reference/dis_trials.csv"), &scenario).unwrap();
    let calibration = Calibration {
        text,
        base: scenario,
        free: Vec::new(),
        target,
        trials: 10,
        first_seed: 100_001,
        seed: 1,
        first_step: 0.25,
    };
    let found = calibration.measure(&[], (100_001..100_011_u64).collect::<Vec<_>>(), &AtomicBool::new(false));
    let spreads: Vec<Spread> =
        found.unwrap().unwrap().iter().filter_map(|values| Spread::of(values)).collect();
    let cell =
        |name: String| best[header.iter().position(|known| known == name).unwrap()].parse::<f64>().unwrap();
    for (quantity, spread) in calibration.target.quantities.iter().zip(&spreads) {
        assert_eq!(
            spread.mean.to_bits(),
            cell(format!("{}_mean", quantity.name)).to_bits(),
            "{}",
            quantity.name
        );
        assert_eq!(spread.sd.to_bits(), cell(format!("{}_sd", quantity.name)).to_bits(), "{}", quantity.name);
    }
}

#[test]
fn a_log_is_held_by_one_process() {
    let place = place();
    let (base, text) = Scenario::load(&place.path().join("short.ron")).unwrap();
    let free = vec![Free::parse("mission.loading_s=1..3", &Fields::of(&text), &Fields::of(&text)).unwrap()];
    let target = Target::load(&place.path().join("target.csv"), &base).unwrap();
    let calibration =
        Calibration { text, base, free, target, trials: 2, first_seed: 1, seed: 1, first_step: 0.25 };
    let out = place.path().join("out");
    let held = Log::open(&out, &calibration, false).unwrap();
    let error = Log::open(&out, &calibration, false).err().unwrap();
    assert!(error.to_string().contains("another process is at work"), "{error}");
    drop(held);
    // A process that another test is just starting may still have the file open.
    let opens = || Log::open(&out, &calibration, false).is_ok();
    assert!((0..100).any(|_| opens() || {
        std::thread::sleep(std::time::Duration::from_millis(50));
        false
    }));
}

/// What `usar reproduce` writes.
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
    let claims = rows("claims.csv");
    assert_eq!(claims.len(), 2 * 2 * 30);
    for row in &claims {
        let [low, high, shared_low, shared_high] =
            ["low", "high", "shared_low", "shared_high"].map(|name| row[name].parse::<f64>().unwrap());
        assert!(shared_low <= low && low <= high && high <= shared_high, "{row:?}");
    }
}

/// What `usar reproduce` prints of ten trials stands in its page.
fn agrees_with_its_page(first: &str) {
    // The verdicts over ten pairs are those of the page, and so is what stands under "first 10".
    let page = read(&root().join("docs/reproduction.md"));
    let cells = |line: &str| -> Vec<String> {
        line.trim_matches('│').split('┆').map(|cell| cell.trim().to_owned()).collect()
    };
    let comparisons = |text: &str| -> Vec<[String; 2]> {
        let rows = text.lines().filter(|line| line.starts_with('│')).map(cells);
        let rows = rows.filter(|row| row.len() == 8 && row[7].ends_with(')'));
        rows.map(|mut row| [row.remove(0), row.remove(6)]).collect()
    };
    assert_eq!(comparisons(first).len(), 2 * 30);
    assert_eq!(comparisons(first), comparisons(&page), "`just pages` makes it anew");
    let verdicts = |text: &str| -> Vec<Vec<String>> {
        let table = text.split("\nVerdicts\n").nth(1).unwrap_or_default();
        let rows = table.lines().filter(|line| line.starts_with('│')).skip(1);
        rows.map(cells).collect()
    };
    let (here, there) = (verdicts(first), verdicts(&page));
    assert!(here.len() >= 10 && here.len() == there.len());
    for (here, there) in here.iter().zip(&there) {
        assert_eq!([&here[0], &here[1], &here[3]], [&there[0], &there[1], &there[3]]);
    }
}

/// The claims over as many trials as the paper has; and the pages in `docs/` with the numbers of these trials.
#[test]
fn the_papers_experiment_and_the_pages_that_tell_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["reproduce", "--trials", "10", "--out", "results/reproduction", "--quiet"];
    let first = succeeds(&usar(folder.path(), &arguments));
    assert_eq!(succeeds(&usar(folder.path(), &arguments)), first, "it is all there already");
    let results = folder.path().join("results/reproduction");
    has_the_files(&results);
    let report = read(&results.join("report.html"));
    assert_eq!(report.matches("<tr class=\"claim\">").count(), 2 * 10, "the claims on both scenarios");
    assert!(report.contains("Not said: it takes 50 trials, there are 10."));
    refused(
        &usar(folder.path(), &["compare", "results/reproduction"]),
        &["these in it are: results/reproduction/paper, results/reproduction/paper-calibrated"],
    );
    refused(
        &usar(folder.path(), &["reproduce", "--out", "results/reproduction/paper"]),
        &["--out: results/reproduction/paper is the folder of one sweep"],
    );
    let example = |n: &str, verdict: &str| {
        let line = first.lines().find(|line| line.contains(n)).unwrap_or_default();
        assert!(line.contains(verdict), "{line}");
    };
    example("Example 2", "┆ holds");
    example("Example 3", "┆ does not hold");

    agrees_with_its_page(&first);

    // The page that tells why has the numbers of the paper's ten trials.
    let page = read(&root().join("docs/why.md"));
    let mut found = 0;
    let renewed = pages::renewed(&page, |command| {
        (command == "explain results/paper").then(|| {
            found += 1;
            pages::answer(program(), folder.path(), "explain results/reproduction/paper")
        })
    });
    assert_eq!(found, 1, "docs/why.md has that command");
    assert_eq!(
        renewed, page,
        "docs/why.md is not what `usar explain results/paper` prints; `just pages` makes it anew"
    );
}

#[test]
fn readings_stand_for_every_combination_and_are_named_by_what_differs() {
    let place = place();
    let folder = place.path();
    let sweep = |readings: &str, policies: &str| {
        let text = format!(
            "(name: \"r\", scenario: \"short.ron\", set: {{\"duration_s\": 30.0}}, policies: {policies}, readings: {readings}, trials: 2, lean: true)"
        );
        std::fs::write(folder.join("r.ron"), text).unwrap();
        usar(folder, &["sweep", "r.ron", "--quiet", "--out", "out", "--fresh"])
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
    refused(&usar(folder, &["verify", "out"]), &["its sweep is lean"]);
    let table = succeeds(&usar(folder, &["readings", "out"]));
    let base = table.lines().find(|line| line.contains("log_base: Two")).unwrap();
    assert!(base.matches(" 0.0 %").count() == 3, "the base of the logarithm decides nothing: {base}");
    assert!(table.contains("The 2 of 4 readings whose trials differ, against each other policy"), "{table}");
    let by_hp = table.lines().find(|line| line.contains("hard_rule: MeanHp")).unwrap();
    assert!(
        by_hp.matches(" 0.0 %").count() < 3 && !by_hp.contains("-nan"),
        "the hard rule decides something: {by_hp}"
    );
    let set = |more: &[&str]| usar(folder, &[&["sweep", "r.ron", "--quiet", "--out", "new"], more].concat());
    refused(
        &set(&["--set", "rne.hard_rule=MeanHp"]),
        &["--set: rne.hard_rule is one of this sweep's readings"],
    );
    refused(&set(&["--policies", "DIS,ENG"]), &["are those of the policy RNE"]);
    assert!(!folder.join("new").exists());
    refused(&sweep("{\"hard_rule\": [MeanHp, MeanHp]}", "[\"RNE\"]"), &["must not stand twice", "MeanHp"]);
    refused(&sweep("{\"wings\": [MeanHp]}", "[\"RNE\"]"), &["rne.wings", "no such field"]);
    refused(&sweep("{\"sort\": []}", "[\"RNE\"]"), &["must have at least one value"]);
    refused(&sweep("{\"sort\": [true]}", "[\"DIS\"]"), &["are those of the policy RNE"]);
}
