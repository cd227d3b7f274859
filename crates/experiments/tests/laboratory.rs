//! Sweeps that survive: broken off, killed, extended, refused, divided and joined; and what is said of them.

mod kills;

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use experiments::sweep::folder::Folder;
use kills::{files, kill_sweeps};
use serde_json::Value;

fn program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_usar"))
}

fn usar(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(program()).args(arguments).current_dir(folder).output().expect("usar runs")
}

/// A folder with `short.ron`, the paper's scenario for half a minute, and `grid.ron`, a sweep file over it.
fn place() -> tempfile::TempDir {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let text = std::fs::read_to_string(root.join("scenarios/paper.ron")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let text = text.replace("duration_s: 600.0", "duration_s: 30.0");
    std::fs::write(folder.path().join("short.ron"), text).unwrap();
    let sweep = "(name: \"paper\", scenario: \"short.ron\", policies: [\"RNE\", \"DIS\", \"ENG\", \"HP_DIS\"], trials: 10)";
    std::fs::write(folder.path().join("short.sweep.ron"), sweep).unwrap();
    let grid = "(
    name: \"grid\",
    description: \"faster carriers\",
    scenario: \"short.ron\",
    set: {\"mission.loading_s\": 1.0},
    policies: [\"RNE\", \"sum=RNE(score: Sum)\", \"DIS\"],
    trials: 2,
    axes: {
        \"roles.carrier.speed_mps\": [1.5, 3.0],
        \"conflicts.priority\": [LowestEnergyFirst, HighestEnergyFirst],
    },
)";
    std::fs::write(folder.path().join("grid.ron"), grid).unwrap();
    folder
}

/// The place of a column in a folder's `trials.csv`.
fn column(results: &Path, name: &str) -> usize {
    let mut table = csv::Reader::from_path(results.join("trials.csv")).unwrap();
    table.headers().unwrap().iter().position(|column| column == name).unwrap()
}

#[track_caller]
fn succeeds(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// The command ends with this status and a message that holds all of these, and leaves the folder of results as it was.
#[track_caller]
fn refused(folder: &Path, status: i32, arguments: &[&str], messages: &[&str]) {
    let results = folder.join("results");
    let content = |path: &Path| if path.is_dir() { format!("{:?}", tree(path)) } else { String::new() };
    let before = content(&results);
    let output = usar(folder, arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{arguments:?}: {stderr}");
    for message in messages {
        assert!(stderr.contains(message), "{arguments:?} must say {message:?}, said {stderr:?}");
    }
    assert!(before == content(&results), "{arguments:?} changed the results");
}

fn tree(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut entries: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    let content = |path: &PathBuf| {
        if path.is_dir() { tree(path) } else { vec![(path.clone(), std::fs::read(path).unwrap())] }
    };
    entries.iter().flat_map(content).collect()
}

fn rows(folder: &Path, table: &str) -> Vec<csv::StringRecord> {
    csv::Reader::from_path(folder.join(table)).unwrap().records().map(Result::unwrap).collect()
}

#[test]
fn a_sweep_killed_at_random_moments_ends_with_the_files_of_one_left_alone() {
    let folder = place();
    let arguments = ["sweep", "short.ron", "--trials", "4", "--policies", "RNE,DIS"];
    let report = kill_sweeps(program(), &arguments, folder.path(), 12, 250);
    assert!(report.kills == 12 && report.sweeps > 0, "{report:?}");
}

#[test]
fn the_same_command_goes_on_and_more_trials_only_add() {
    let folder = place();
    let sweep = |more: &[&str]| {
        usar(folder.path(), &[&["sweep", "short.ron", "--policies", "RNE,DIS"], more].concat())
    };
    succeeds(&sweep(&["--trials", "2"]));
    let results = folder.path().join("results/paper");
    let again = sweep(&["--trials", "2"]);
    assert!(String::from_utf8_lossy(&again.stderr).contains("4 of 4 trials are there already"));
    let more = sweep(&["--trials", "3"]);
    assert!(String::from_utf8_lossy(&more.stderr).contains("4 of 6 trials are there already"));
    succeeds(&sweep(&["--trials", "3", "--out", "results/whole"]));
    assert!(files(&results) == files(&folder.path().join("results/whole")), "added trials change no byte");
    // The file says 10; the folder has 3: nobody asked for a number, so there is nothing to refuse.
    std::fs::write(folder.path().join("one.ron"), small_default(folder.path())).unwrap();
    let plain = usar(folder.path(), &["sweep", "one.ron", "--policies", "RNE,DIS"]);
    assert!(String::from_utf8_lossy(&plain.stderr).contains("6 of 6 trials are there already"));
}

/// `short.ron` with a single trial by default.
fn small_default(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("short.ron")).unwrap().replace("trials: 10", "trials: 1")
}

#[test]
fn another_sweep_in_the_folder_is_refused_and_each_difference_named() {
    let folder = place();
    let here = folder.path();
    let sweep = ["sweep", "short.ron", "--policies", "RNE,DIS", "--trials", "2"];
    succeeds(&usar(here, &sweep));
    let with = |more: &[&'static str]| [&sweep[..], more].concat();
    refused(
        here,
        2,
        &with(&["--set", "costs.energy.per_step=0.009"]),
        &["results/paper has results of something else", "costs.energy.per_step: 0.0045 there, 0.009 now"],
    );
    refused(here, 2, &with(&["--seed", "7"]), &["seeds: from 1 on there, from 7 on now"]);
    refused(here, 2, &with(&["--check"]), &["--check: false there, true now"]);
    refused(
        here,
        2,
        &["sweep", "short.ron", "--policies", "RNE,DIS", "--trials", "1"],
        &["trials: 2 there, 1 now"],
    );
    refused(
        here,
        2,
        &["sweep", "short.ron", "--policies", "ENG", "--trials", "2"],
        &["policies: RNE, DIS there, ENG now"],
    );
    refused(here, 2, &["sweep", "short.ron", "--set", "costs.energy=1"], &["--set: costs.energy: "]);
    refused(here, 2, &["sweep", "short.ron", "--set", "dt_s=-1"], &["--set: dt_s must"]);
    succeeds(&usar(here, &["sweep", "short.ron", "--policies", "ENG", "--trials", "1", "--fresh"]));
    assert_eq!(rows(&here.join("results/paper"), "trials.csv").len(), 1);
}

#[test]
fn a_sweep_file_spans_its_grid_and_any_field_can_be_an_axis() {
    let folder = place();
    let here = folder.path();
    let said = succeeds(&usar(here, &["sweep", "grid.ron"]));
    assert!(said.contains("roles.carrier.speed_mps=1.5, conflicts.priority=HighestEnergyFirst"), "{said}");
    let results = here.join("results/grid");
    let trials = rows(&results, "trials.csv");
    assert_eq!(trials.len(), 2 * 2 * 3 * 2);
    assert_eq!(trials[23].iter().take(4).collect::<Vec<_>>(), ["4", "3.0", "HighestEnergyFirst", "DIS"]);
    let column = |name: &str| column(&results, name);
    let distance = |row: &csv::StringRecord| row[column("distance_m")].parse::<f64>().unwrap();
    assert!(distance(&trials[18]) > 1.2 * distance(&trials[0]), "faster carriers go farther");
    assert_eq!(succeeds(&usar(here, &["verify", "results/grid"])), "24 of 24 trials match, step by step\n");
    // A row can be run again alone.
    let policy = "RNE(score: Sum)";
    let arguments = ["run", "results/grid/resolved.ron", "--policy", policy, "--seed", "2", "--json"];
    let set = ["--set", "roles.carrier.speed_mps=3.0"];
    let run: Value = serde_json::from_str(&succeeds(&usar(here, &[&arguments[..], &set].concat()))).unwrap();
    let row = trials.iter().find(|row| &row[0] == "3" && &row[3] == "sum" && &row[4] == "2").unwrap();
    assert_eq!(run["state_hash"], row[column("state_hash")]);
}

#[test]
fn bad_sweep_files_are_refused_with_their_lines() {
    let folder = place();
    let here = folder.path();
    let grid = std::fs::read_to_string(here.join("grid.ron")).unwrap();
    let refuse = |from: &str, to: &str, message: &str| {
        assert!(grid.contains(from));
        std::fs::write(here.join("bad.ron"), grid.replace(from, to)).unwrap();
        refused(here, 2, &["sweep", "bad.ron"], &[message]);
    };
    refuse(
        "carrier.speed_mps",
        "carrier.speed",
        "bad.ron:9: axes.\"roles.carrier.speed\"[0]: roles.carrier.speed: no such field; roles.carrier has ",
    );
    refuse("[1.5, 3.0]", "[1.5, \"fast\"]", "bad.ron:9: axes.\"roles.carrier.speed_mps\"[1]: ");
    refuse(
        "[1.5, 3.0]",
        "[1.5, -3.0]",
        "roles.carrier.speed_mps=-3.0: conflicts.priority=LowestEnergyFirst: roles.carrier.speed_mps must",
    );
    refuse("[1.5, 3.0]", "[1.5, 1.5]", "must not be listed twice, found 1.5");
    refuse("[1.5, 3.0]", "[]", "must have at least one value");
    refuse("\"mission.loading_s\"", "\"mission.loading\"", "bad.ron:5: set.\"mission.loading\": ");
    refuse("trials: 2", "trails: 2", "bad.ron:7:");
    refuse("short.ron", "long.ron", "long.ron: cannot be read");
    refuse("score: Sum", "score: Most", "policies: policy RNE: ");
    refuse("\"DIS\"", "\"RNE\"", "policies: must not be listed twice, found \"RNE\"");
    refuse(
        "trials: 2",
        "trials: 3, seeds: [1, 2]",
        "trials: must be at most the number of listed seeds, 2, found 3",
    );
    refuse("trials: 2", "seeds: [1, 2], first_seed: 1", "seeds: must not be given beside first_seed");
}

#[test]
fn shards_are_joined_to_the_bytes_of_a_single_run() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, &["sweep", "grid.ron", "--out", "whole"]));
    for shard in ["1/3", "2/3", "3/3"] {
        succeeds(&usar(here, &["sweep", "grid.ron", "--shard", shard]));
    }
    let parts = ["results/grid-1-of-3", "results/grid-2-of-3", "results/grid-3-of-3"];
    let merge = |parts: &[&'static str]| [&["merge"], parts, &["--out", "joined"]].concat();
    refused(here, 2, &merge(&parts[..2]), &["shard 3/3 is not there: missing trials, 8: "]);
    succeeds(&usar(here, &["sweep", "grid.ron", "--shard", "3/3", "--trials", "3", "--out", "results/more"]));
    refused(
        here,
        2,
        &merge(&[parts[0], "results/more"]),
        &["are not of one sweep", "trials: 2 there, 3 now"],
    );
    succeeds(&usar(here, &["sweep", "short.ron", "--trials", "1", "--out", "results/other"]));
    refused(here, 2, &merge(&[parts[0], "results/other"]), &["are not of one sweep", "axes: "]);
    succeeds(&usar(here, &merge(&parts)));
    assert!(files(&here.join("joined")) == files(&here.join("whole")));
    refused(here, 2, &["sweep", "grid.ron", "--shard", "4/3"], &["must be i/n with i from 1 to n"]);
}

#[test]
fn changed_bytes_are_named_and_made_again() {
    let folder = place();
    let here = folder.path();
    let sweep = ["sweep", "short.ron", "--policies", "RNE,DIS", "--trials", "2"];
    succeeds(&usar(here, &sweep));
    let results = here.join("results/paper");
    let sound = files(&results);
    let damage = |name: &str, change: fn(&mut Vec<u8>)| {
        let mut bytes = sound[name].clone();
        change(&mut bytes);
        std::fs::write(results.join(name), bytes).unwrap();
    };
    let mended = |message: &str| {
        let output = usar(here, &sweep);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && stderr.contains(message), "{stderr}");
        assert!(files(&results) == sound, "{message}");
    };
    let flip = |bytes: &mut Vec<u8>| {
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
    };
    damage("journal.jsonl", flip);
    refused(here, 2, &["compare", "results/paper"], &["journal.jsonl:", "checksum does not match"]);
    mended("the checksum does not match");
    damage("journal.jsonl", |bytes| bytes.truncate(bytes.len() - 100));
    refused(here, 2, &["compare", "results/paper"], &["journal.jsonl:4: the last line is cut off"]);
    mended("journal.jsonl:4: the last line is cut off");
    damage("trials.csv", flip);
    refused(here, 2, &["compare", "results/paper"], &["trials.csv"]);
    mended("trials.csv: does not have the checksum");
    damage("hashes.csv", |bytes| bytes.truncate(1000));
    mended("hashes.csv: does not have the checksum");
    std::fs::remove_file(results.join("robots.csv")).unwrap();
    mended("robots.csv: does not have the checksum");
    damage("manifest.json", |bytes| bytes.truncate(100));
    refused(here, 2, &sweep, &["manifest.json: is not a manifest of this program"]);
    succeeds(&usar(here, &[&sweep[..], &["--fresh"]].concat()));
    assert!(files(&results) == sound);
}

#[test]
fn trouble_with_the_disk_breaks_nothing() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, &["sweep", "short.ron", "--policies", "RNE", "--trials", "4", "--out", "whole"]));
    // Files may not grow beyond some blocks: what a full disk does, without one.
    for blocks in ["1", "12", "20"] {
        let limited = format!(
            "trap '' XFSZ; ulimit -f {blocks}; exec '{}' sweep short.ron --policies RNE --trials 4 --quiet",
            program().display()
        );
        let output = Command::new("sh").args(["-c", &limited]).current_dir(here).output().unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{blocks}: {stderr}");
        assert!(stderr.contains("File too large"), "{stderr}");
    }
    succeeds(&usar(here, &["sweep", "short.ron", "--policies", "RNE", "--trials", "4"]));
    assert!(
        files(&here.join("results/paper")) == files(&here.join("whole")),
        "it goes on when the cause is gone"
    );

    std::fs::write(here.join("file"), "").unwrap();
    refused(here, 3, &["sweep", "short.ron", "--out", "file/results"], &["cannot write to file/results"]);

    let lock = std::fs::File::open(here.join("results/paper/.lock")).unwrap();
    lock.lock().unwrap();
    refused(
        here,
        3,
        &["sweep", "short.ron", "--policies", "RNE", "--trials", "4"],
        &["results/paper: another process is at work in this folder"],
    );
}

#[test]
fn an_interrupted_sweep_stops_at_once_and_goes_on() {
    let folder = place();
    let here = folder.path();
    let sweep = ["sweep", "short.ron", "--policies", "RNE", "--trials", "60"];
    let child = Command::new(program()).args(sweep).current_dir(here).stderr(Stdio::piped()).spawn().unwrap();
    let journal = here.join("results/paper/journal.jsonl");
    while std::fs::metadata(&journal).map_or(0, |file| file.len()) == 0 {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let since = Instant::now();
    let output = child.wait_with_output().unwrap();
    assert!(since.elapsed() < Duration::from_secs(2));
    assert_eq!(output.status.code(), Some(130));
    assert!(String::from_utf8_lossy(&output.stderr).contains("and the same command goes on"));
    let again = usar(here, &sweep);
    succeeds(&again);
    assert!(String::from_utf8_lossy(&again.stderr).contains("of 60 trials are there already"));
    assert_eq!(rows(&here.join("results/paper"), "trials.csv").len(), 60);
}

#[test]
fn trials_that_give_nothing_are_rows_that_can_be_run_again() {
    let folder = place();
    let here = folder.path();
    let sweep = ["sweep", "short.ron", "--policies", "RNE,DIS", "--trials", "2", "--set", "duration_s=600.0"];
    let late = usar(here, &[&sweep[..], &["--max-trial-s", "0.001"]].concat());
    assert_eq!(late.status.code(), Some(1));
    let said = String::from_utf8_lossy(&late.stdout).into_owned();
    assert!(said.contains("4 trials failed, 0 are missing"), "{said}");
    assert!(String::from_utf8_lossy(&late.stderr).contains("trial 1 of RNE (seed 1) timed out"));
    let late = rows(&here.join("results/paper"), "trials.csv");
    let last = |row: &csv::StringRecord| row.iter().next_back().unwrap().to_owned();
    let [status, rescuees] =
        ["status", "rescuees_total"].map(|name| column(&here.join("results/paper"), name));
    let is_late = |row: &csv::StringRecord| &row[status] == "timed_out" && row[rescuees].is_empty();
    assert!(late.len() == 4 && late.iter().all(is_late));
    assert_eq!(last(&late[3]), "usar run resolved.ron --policy DIS --seed 2");
    // That may have been the machine's fault, so they are run again.
    succeeds(&usar(here, &sweep));
    assert!(rows(&here.join("results/paper"), "trials.csv").iter().all(|row| &row[status] == "completed"));
}

#[test]
fn comparisons_are_paired_and_say_what_they_stand_on() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(
        here,
        &["sweep", "short.ron", "--policies", "RNE,DIS,ENG", "--trials", "6", "--set", "duration_s=120"],
    ));
    let json: Value = serde_json::from_str(&succeeds(&usar(
        here,
        &[
            "compare",
            "results/paper",
            "--metric",
            "distance",
            "--metric",
            "rescuees.hard",
            "--baseline",
            "DIS",
            "--json",
        ],
    )))
    .unwrap();
    let comparisons = json["comparisons"].as_array().unwrap();
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
    let [low, high] = [0, 1].map(|i: usize| comparisons[0]["interval"][i].as_f64().unwrap());
    assert!(low <= mean && mean <= high);
    let text = succeeds(&usar(here, &["compare", "results/paper"]));
    assert!(text.contains("Holm's correction over the 30 comparisons above"), "{text}");
    assert!(text.contains("in which the metric is not defined"), "{text}");
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    assert_eq!(text, succeeds(&usar(here, &["compare", "results/paper"])), "the bootstrap is seeded");
    refused(
        here,
        2,
        &["compare", "results/paper", "--metric", "luck"],
        &["unknown metric \"luck\"; known metrics: rescuees.total"],
    );
    refused(
        here,
        2,
        &["compare", "results/paper", "--baseline", "RANDOM"],
        &["must be a policy of the sweep (RNE, DIS, ENG)"],
    );
    refused(
        here,
        2,
        &["compare", "results/paper", "--policies", "RNE,RANDOM"],
        &["--policies: must be a policy of the sweep (RNE, DIS, ENG), found \"RANDOM\""],
    );
    refused(here, 2, &["compare", "results/paper", "--policies", "RNE"], &["nothing to compare: RNE only"]);
    let two = ["compare", "results/paper", "--policies", "ENG, RNE", "--metric", "rescuees.hard"];
    let two = succeeds(&usar(here, &two));
    assert!(two.contains("┆ RNE - ENG ┆") && !two.contains("DIS"), "{two}");
    refused(here, 2, &["compare", "results"], &["results: is not the folder of a sweep"]);
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
fn an_estimate_says_trials_time_and_disk() {
    let folder = place();
    let json: Value = serde_json::from_str(&succeeds(&usar(
        folder.path(),
        &["estimate", "grid.ron", "--trials", "100", "--json"],
    )))
    .unwrap();
    assert_eq!((&json["trials"], &json["cases"], &json["policies"]), (&1200.into(), &4.into(), &3.into()));
    assert_eq!(json["measured"], 24, "all policies on eight of the seeds");
    assert!(json["seconds"].as_f64().unwrap() > 0.0 && json["bytes"].as_u64().unwrap() > 1200 * 1000);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3, "nothing is left behind");
    let alike = [
        "estimate",
        "short.ron",
        "--policies",
        "DIS, RNE(log_base: Two), RNE(log_base: Ten)",
        "--trials",
        "100",
        "--json",
    ];
    let json: Value = serde_json::from_str(&succeeds(&usar(folder.path(), &alike))).unwrap();
    assert_eq!((&json["measured"], &json["simulated"]), (&24.into(), &16.into()), "the base decides nothing");
}

#[test]
fn a_report_is_one_file_with_figures_and_the_numbers_behind_them() {
    let folder = place();
    let here = folder.path();
    refused(here, 2, &["report", "results"], &["results: is not the folder of a sweep"]);
    succeeds(&usar(here, &["sweep", "grid.ron", "--set", "duration_s=120", "--trials", "3"]));
    assert_eq!(succeeds(&usar(here, &["report", "results/grid"])), "results/grid/report.html\n");
    let results = here.join("results/grid");
    let page = std::fs::read_to_string(results.join("report.html")).unwrap();
    // Nothing is fetched: the only addresses are names of formats.
    for source in ["src=", "@import", "url(\"http", "<script", "<link"] {
        assert!(!page.contains(source), "{source}");
    }
    assert!(page.replace("http://www.w3.org/", "").matches("http").count() == 0);
    assert!(!page.contains("NaN") && !page.contains(">inf"));
    let plots = files(&results.join("plots"));
    for name in [
        "rescuees",
        "energy-per-rescuee",
        "hp-per-rescuee",
        "waiting-and-deadlocks",
        "costs",
        "differences",
        "rescuees-over-time",
        "groups",
        "levels",
        "trust",
        "along-roles-carrier-speed_mps",
        "along-conflicts-priority",
    ] {
        assert!(page.contains(&format!("<figure id=\"{name}\">")), "{name}");
        assert!(plots[&format!("{name}.svg")].starts_with(b"<svg viewBox="), "{name}");
        let table = csv::Reader::from_reader(&*plots[&format!("{name}.csv")]).records().count();
        assert!(table > 0, "{name}");
    }
    for words in [
        "sum",
        "faster carriers",
        "roles.carrier.speed_mps=1.5",
        "usar sweep sweep.ron",
        "duration_s: 120",
        "Holm",
    ] {
        assert!(page.contains(words), "{words}");
    }
    succeeds(&usar(here, &["report", "results/grid"]));
    assert_eq!(page, std::fs::read_to_string(results.join("report.html")).unwrap(), "the same bytes again");
    refused(here, 2, &["report", "results/grid", "--case", "5"], &["--case: must be from 1 to 4, found 5"]);
    // The sweep still goes on in a folder with a report.
    succeeds(&usar(here, &["sweep", "grid.ron", "--set", "duration_s=120", "--trials", "3"]));
}

/// The table of trials has each metric of each trial, to the bit.
fn every_metric_is_a_column(results: &Path, trials: &[csv::StringRecord]) {
    let sweep = Folder::read(results).unwrap();
    let metrics = &sweep.experiment().metrics;
    let places: Vec<usize> = metrics.iter().map(|metric| column(results, &metric.column())).collect();
    assert_eq!(trials.len(), sweep.results().len());
    for (row, measured) in trials.iter().zip(sweep.results().values()) {
        let cells = places.iter().map(|place| row[*place].parse().ok().map(f64::to_bits));
        let values = measured.metrics.as_ref().unwrap().iter().map(|value| value.map(f64::to_bits));
        assert!(cells.eq(values), "{row:?}");
    }
}

/// The numbers of a figure are those of the tables.
#[test]
fn the_reports_numbers_are_those_of_the_trials() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(
        here,
        &["sweep", "short.ron", "--policies", "RNE,DIS", "--trials", "3", "--set", "duration_s=120"],
    ));
    succeeds(&usar(here, &["report", "results/paper"]));
    let results = here.join("results/paper");
    let trials = rows(&results, "trials.csv");
    every_metric_is_a_column(&results, &trials);
    let rescuees = column(&results, "rescuees_total");
    let rescued: Vec<f64> =
        trials.iter().filter(|row| &row[0] == "DIS").map(|row| row[rescuees].parse().unwrap()).collect();
    let last = rows(&results.join("plots"), "rescuees-over-time.csv")
        .into_iter()
        .rfind(|row| &row[0] == "rescuees.total" && &row[1] == "DIS")
        .unwrap();
    assert_eq!((&last[2], &last[3]), ("120", "3"));
    assert!((last[4].parse::<f64>().unwrap() - rescued.iter().sum::<f64>() / 3.0).abs() < 1e-9);
    // The heat map of trust is what `usar trust` says of the same needs.
    let robots = rows(&results, "groups.csv");
    let needs = |robot: &str| -> Vec<f64> {
        let row = robots
            .iter()
            .find(|row| &row[0] == "RNE" && &row[1] == "1" && &row[3] == "1" && &row[4] == robot);
        row.unwrap().iter().skip(9).map(|need| need.parse().unwrap()).collect()
    };
    let all: Vec<Vec<f64>> = (0..12).map(|robot| needs(&robot.to_string())).collect();
    let weights: Vec<String> =
        (0..7).map(|k| (1.0 / all.iter().map(|needs| needs[k]).fold(0.0, f64::max)).to_string()).collect();
    let text = |needs: &[f64]| needs.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    let (from, to, weights) = (text(&all[0]), text(&all[1]), weights.join(","));
    let said =
        succeeds(&usar(here, &["trust", "--weights", &weights, "--from", &from, "--to", &to, "--json"]));
    let rne = serde_json::from_str::<Value>(&said).unwrap()["rne"].as_f64().unwrap();
    let shown = &rows(&results.join("plots"), "trust.csv")[1];
    assert_eq!((&shown[0], &shown[1]), ("0", "1"));
    assert!((shown[2].parse::<f64>().unwrap() - rne).abs() < 1e-12);
}

#[test]
fn the_sweep_file_in_the_folder_makes_it_again() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, &["sweep", "grid.ron", "--set", "duration_s=20", "--trials", "1"]));
    let results = here.join("results/grid");
    succeeds(&usar(&results, &["sweep", "sweep.ron", "--out", "again"]));
    let (before, again) = (files_but(&results), files_but(&results.join("again")));
    assert_eq!(before, again);
}

/// The tables of a folder.
fn files_but(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let names = ["trials.csv", "rounds.csv", "hashes.csv", "journal.jsonl", "resolved.ron"];
    names.iter().map(|name| ((*name).to_owned(), std::fs::read(folder.join(name)).unwrap())).collect()
}

#[test]
fn other_peoples_files_are_left_alone() {
    let folder = place();
    let here = folder.path();
    let message = &["is not empty and not the folder of a sweep; nothing was overwritten"];
    for (name, content) in [("trials.csv", "method,trial\nDIS,1\n"), ("manifest.json", "{\"name\": \"web\"}")]
    {
        let results = here.join("results");
        std::fs::create_dir_all(&results).unwrap();
        std::fs::write(results.join(name), content).unwrap();
        refused(here, 2, &["sweep", "short.ron", "--out", "results"], message);
        refused(here, 2, &["sweep", "short.ron", "--out", "results", "--fresh"], message);
        std::fs::remove_dir_all(&results).unwrap();
    }
}

#[test]
fn a_changed_manifest_or_a_journal_that_lacks_lines_is_noticed() {
    let folder = place();
    let here = folder.path();
    let sweep = ["sweep", "short.ron", "--policies", "RNE,DIS", "--trials", "2"];
    succeeds(&usar(here, &sweep));
    let results = here.join("results/paper");
    let sound = files(&results);
    let text = |name: &str| String::from_utf8(sound[name].clone()).unwrap();
    std::fs::write(
        results.join("manifest.json"),
        text("manifest.json").replace("\"trials\": 2", "\"trials\": 3"),
    )
    .unwrap();
    refused(here, 2, &["compare", "results/paper"], &["manifest.json", "its checksum does not match"]);
    std::fs::write(results.join("manifest.json"), text("manifest.json")).unwrap();
    let journal: Vec<&str> = text("journal.jsonl").leak().lines().collect();
    std::fs::write(results.join("journal.jsonl"), journal[..3].join("\n") + "\n").unwrap();
    refused(
        here,
        2,
        &["compare", "results/paper"],
        &["do not have the checksums of the manifest: journal.jsonl"],
    );
    succeeds(&usar(here, &sweep));
    assert!(files(&results) == sound);
}

#[test]
fn trials_that_took_too_long_are_counted_and_joined() {
    let folder = place();
    let here = folder.path();
    let sweep = ["sweep", "short.ron", "--policies", "RNE,DIS", "--trials", "2", "--set", "duration_s=600.0"];
    for shard in ["1/2", "2/2"] {
        let late = usar(here, &[&sweep[..], &["--shard", shard, "--max-trial-s", "0.001"]].concat());
        assert_eq!(late.status.code(), Some(1));
    }
    let parts = ["results/paper-1-of-2", "results/paper-2-of-2"];
    let merged = usar(here, &["merge", parts[0], parts[1], "--out", "results/whole"]);
    assert_eq!(merged.status.code(), Some(1), "{}", String::from_utf8_lossy(&merged.stderr));
    let said = succeeds(&usar(here, &["compare", "results/whole", "--metric", "rescuees.hard"]));
    assert!(said.contains("2 with a failed trial, 0 with"), "{said}");
    // Joined once more, nothing changes.
    let before = files(&here.join("results/whole"));
    usar(here, &["merge", parts[0], parts[1], "--out", "results/whole"]);
    assert!(files(&here.join("results/whole"))["journal.jsonl"] == before["journal.jsonl"]);
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
    // Nobody is rescued within half a minute: no pair differs from another.
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
fn strange_texts_are_refused_in_words() {
    let folder = place();
    let here = folder.path();
    std::fs::write(here.join("deep.ron"), "(".repeat(200_000)).unwrap();
    refused(here, 2, &["check", "deep.ron"], &["deep.ron:"]);
    refused(here, 2, &["sweep", "short.ron", "--policies", "RNE(score: '日')"], &["policies: policy RNE: "]);
    refused(here, 2, &["sweep", "short.ron", "--set", "duration_s='日'"], &["--set: duration_s: "]);
    refused(
        here,
        2,
        &["sweep", "short.ron", "--set", &format!("dt_s={}", "[".repeat(100_000))],
        &["--set: dt_s: "],
    );
    refused(
        here,
        2,
        &["sweep", "short.ron", "--set", "description=\"more\""],
        &["--set: description: decides no number"],
    );
    refused(
        here,
        2,
        &["sweep", "grid.ron", "--set", "roles[0].speed_mps=2.0"],
        &["--set: roles.carrier.speed_mps is an axis"],
    );
    let grid = std::fs::read_to_string(here.join("grid.ron")).unwrap();
    let commented = grid.replace("[1.5, 3.0]", "[1.5, // as printed\n 3.0 /* twice */]");
    std::fs::write(here.join("commented.ron"), commented).unwrap();
    succeeds(&usar(here, &["check", "commented.ron"]));
    for (from, to, message) in [
        (
            "[1.5, 3.0]",
            "[3, 3.0]",
            "axes.\"roles.carrier.speed_mps\"[1]: must not be listed twice, found 3.0",
        ),
        ("roles.carrier.speed_mps", "description", "decides no number of a trial"),
        (
            "conflicts.priority",
            "roles[0]",
            "must not be a part of another axis, found roles.carrier.speed_mps",
        ),
        ("sum=RNE", "DIS=RNE", "must not be the name of another policy"),
        ("sum=RNE", "a\\nb=RNE", "must be visible characters"),
        ("trials: 2", "seeds: [4, 4]", "seeds: must differ"),
    ] {
        std::fs::write(here.join("bad.ron"), grid.replace(from, to)).unwrap();
        refused(here, 2, &["sweep", "bad.ron"], &[message]);
    }
}
