//! Sweep files: their grids, their shards, and errors in them.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value;

use crate::altered_results::files;
use crate::place::{column, place, refused, rows};
use crate::support::{read, succeeds, usar};

#[test]
fn a_sweep_file_spans_its_grid_and_any_field_can_be_an_axis() {
    let folder = place();
    let here = folder.path();
    let said = succeeds(&usar(here, "sweep grid.ron"));
    assert!(said.contains("roles.carrier.speed_mps=1.5, conflicts.priority=HighestEnergyFirst"), "{said}");
    let results = here.join("results/grid");
    let trials = rows(&results, "trials.csv");
    assert_eq!(trials.len(), 2 * 2 * 3 * 2);
    assert_eq!(trials[23].iter().take(4).collect::<Vec<_>>(), ["4", "3.0", "HighestEnergyFirst", "DIS"]);
    let column = |name: &str| column(&results, name);
    let distance = |row: &csv::StringRecord| row[column("distance_m")].parse::<f64>().unwrap();
    assert!(distance(&trials[18]) > 1.2 * distance(&trials[0]), "faster carriers go farther");
    assert!(succeeds(&usar(here, "verify results/grid")).starts_with("24 of 24 trials match, step by step"));
    // A single row can be run again.
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
        refused(here, 2, "sweep bad.ron", &[message]);
    };
    refuse(
        "carrier.speed_mps",
        "carrier.speed",
        "bad.ron:9: axes.\"roles.carrier.speed\"[0]: roles.carrier.speed is no field; there are \
         name, kind, radius_m",
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
    refuse("score: Sum", "score: Most", "bad.ron:6: policies[1]: policy RNE: ");
    refuse("\"DIS\"", "\"RNE\"", "bad.ron:6: policies[2]: must not be listed twice, found \"RNE\"");
    refuse(
        "trials: 2",
        "trials: 3, seeds: [1, 2]",
        "bad.ron:7: trials: must be at most the number of listed seeds, 2, found 3",
    );
    refuse("trials: 2", "seeds: [1, 2], first_seed: 1", "seeds: must not be given beside first_seed");
    // Several mistakes at once, each with its line.
    let bad = grid
        .replace("\"mission.loading_s\"", "\"mission.loading\"")
        .replace("score: Sum", "score: Most")
        .replace("trials: 2", "trials: 2, primary: [\"rescued\"], margins: {\"rescuees\": 0}")
        .replace("[1.5, 3.0]", "[1.5, \"fast\"]");
    let axis = "bad.ron:9: axes.\"roles.carrier.speed_mps\"[1]: ";
    std::fs::write(here.join("bad.ron"), bad).unwrap();
    let told = [
        "bad.ron:5: set.\"mission.loading\": ",
        "bad.ron:6: policies[1]: ",
        "bad.ron:7: primary[0]: ",
        "bad.ron:7: margins.\"rescuees\": must be a number above 0, found 0",
    ];
    // Without a scenario that can be used, metrics and axes cannot be judged.
    refused(here, 2, "sweep bad.ron", &told[..2]);
    let bad = grid
        .replace("score: Sum", "score: Most")
        .replace("trials: 2", "trials: 2, primary: [\"rescued\"], margins: {\"rescuees\": 0}")
        .replace("[1.5, 3.0]", "[1.5, \"fast\"]");
    std::fs::write(here.join("bad.ron"), bad).unwrap();
    refused(here, 2, "sweep bad.ron", &[told[1], told[2], told[3], axis]);
    // A rule that a value of `set` breaks has its line; what else is wrong may come from it.
    std::fs::write(
        here.join("bad.ron"),
        grid.replace("\"mission.loading_s\"", "\"mission.rest_s\": -1, \"mission.loading_s\""),
    )
    .unwrap();
    refused(here, 2, "sweep bad.ron", &["bad.ron:5: set.\"mission.rest_s\": mission.rest_s must be"]);
}

#[test]
fn a_door_is_one_axis_only_by_whatever_name() {
    let folder = place();
    let here = folder.path();
    let walls = "[(from: (0, 8), to: (20, 8), doors: [(at_m: 3, width_m: 2, name: \"gate\")])]";
    let short = std::fs::read_to_string(here.join("short.ron")).unwrap();
    let arena = short.find("arena_m").unwrap();
    std::fs::write(
        here.join("walled.ron"),
        format!("{}walls: {walls}, {}", &short[..arena], &short[arena..]),
    )
    .unwrap();
    let sweep = |axes: &str| {
        let text =
            format!("(name: \"doors\", scenario: \"walled.ron\", policies: [\"RNE\"], axes: {{{axes}}})");
        std::fs::write(here.join("doors.ron"), text).unwrap();
    };
    sweep("\"walls[0].doors.gate.closed\": [true, false]");
    succeeds(&usar(here, "check doors.ron"));
    for both in ["closed\": [true, false]", "width_m\": [2, 3]"] {
        sweep(&format!("\"walls[0].doors.gate.{both}, \"walls[0].doors[0].{both}"));
        refused(
            here,
            2,
            "sweep doors.ron",
            &["must not be a part of another axis, found walls[0].doors.gate"],
        );
    }
    sweep("\"walls[0].doors[0].closed\": [true, false]");
    let set = "walls[0].doors.gate.closed=false";
    refused(
        here,
        2,
        &["sweep", "doors.ron", "--set", set],
        &["--set: walls[0].doors[0].closed is on an axis"],
    );
}

#[test]
fn strange_texts_are_refused_in_words() {
    let folder = place();
    let here = folder.path();
    std::fs::write(here.join("deep.ron"), "(".repeat(200_000)).unwrap();
    refused(here, 2, "check deep.ron", &["deep.ron:"]);
    refused(
        here,
        2,
        &["sweep", "short.ron", "--policies", "RNE(score: '日')"],
        &["policies: options must be"],
    );
    refused(
        here,
        2,
        "sweep short.ron --set duration_s='日'",
        &["--set: duration_s must be one value in RON"],
    );
    refused(
        here,
        2,
        &["sweep", "short.ron", "--set", &format!("dt_s={}", "[".repeat(100_000))],
        &["--set: dt_s must be one value in RON"],
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
        "sweep grid.ron --set roles[0].speed_mps=2.0",
        &["--set: roles.carrier.speed_mps is on an axis"],
    );
    let grid = std::fs::read_to_string(here.join("grid.ron")).unwrap();
    let commented = grid.replace("[1.5, 3.0]", "[1.5, // as printed\n 3.0 /* twice */]");
    std::fs::write(here.join("commented.ron"), commented).unwrap();
    succeeds(&usar(here, "check commented.ron"));
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
        refused(here, 2, "sweep bad.ron", &[message]);
    }
}

#[test]
fn the_sweep_file_in_the_folder_makes_it_again() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, "sweep grid.ron --set duration_s=20 --trials 1"));
    let results = here.join("results/grid");
    succeeds(&usar(&results, "sweep sweep.ron --out again"));
    let (before, again) = (files_but(&results), files_but(&results.join("again")));
    assert_eq!(before, again);
}

#[test]
fn a_sweep_file_is_run_in_another_scenario() {
    let folder = place();
    let here = folder.path();
    let others = "--scenario leak --set duration_s=20 --trials 1";
    succeeds(&usar(here, format!("sweep grid.ron {others}").as_str()));
    let grid = read(&here.join("grid.ron")).replace("\"grid\"", "\"leak\"");
    std::fs::write(here.join("leak.ron"), grid.replace("short.ron", "usar:/leak.ron")).unwrap();
    succeeds(&usar(here, "sweep leak.ron --set duration_s=20 --trials 1"));
    let (other, named) = (here.join("results/grid-leak"), here.join("results/leak"));
    assert_eq!(files_but(&other), files_but(&named));
    let message = "error: --scenario: is for a sweep file, and short.ron is a scenario itself";
    std::fs::remove_file(here.join("short.sweep.ron")).unwrap();
    refused(here, 2, format!("sweep short.ron {others}").as_str(), &[message]);
    refused(here, 2, "sweep grid.ron --scenario gone.ron", &["error: gone.ron: "]);
    refused(
        here,
        2,
        format!("study deceit results/leak {others}").as_str(),
        &["--scenario: is for a sweep file, and "],
    );
}

/// The tables of a folder.
fn files_but(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let names = ["trials.csv", "rounds.csv", "hashes.csv", "journal.jsonl.gz", "resolved.ron"];
    names.iter().map(|name| ((*name).to_owned(), std::fs::read(folder.join(name)).unwrap())).collect()
}

#[test]
fn shards_are_joined_to_the_bytes_of_a_single_run() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, "sweep grid.ron --out whole"));
    for shard in ["1/3", "2/3", "3/3"] {
        succeeds(&usar(here, &["sweep", "grid.ron", "--shard", shard]));
    }
    let parts = ["results/grid-1-of-3", "results/grid-2-of-3", "results/grid-3-of-3"];
    let merge = |parts: &[&'static str]| [&["cluster", "merge"], parts, &["--out", "joined"]].concat();
    refused(
        here,
        2,
        &merge(&parts[..2]),
        &[
            "shard 3/3: missing trials, 6: ",
            "\n  usar sweep results/grid-1-of-3/sweep.ron --shard 3/3 --out results/3\n",
        ],
    );
    succeeds(&usar(here, "sweep grid.ron --shard 3/3 --trials 3 --out results/more"));
    refused(
        here,
        2,
        &merge(&[parts[0], "results/more"]),
        &["are not of one sweep", "trials: 2 there, 3 now"],
    );
    succeeds(&usar(here, "sweep short.ron --trials 1 --out results/other"));
    refused(here, 2, &merge(&[parts[0], "results/other"]), &["are not of one sweep", "axes: "]);
    succeeds(&usar(here, &merge(&parts)));
    assert!(files(&here.join("joined")) == files(&here.join("whole")));
    refused(here, 2, "sweep grid.ron --shard 4/3", &["must be i/n with i from 1 to n"]);
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
    let merged = usar(here, &["cluster", "merge", parts[0], parts[1], "--out", "results/whole"]);
    assert_eq!(merged.status.code(), Some(1), "{}", String::from_utf8_lossy(&merged.stderr));
    let said = succeeds(&usar(here, "compare results/whole --metric rescuees.hard"));
    assert!(said.contains("Pairs left out, over all comparisons: 2 with a failed trial."), "{said}");
    // Merging again changes nothing.
    let before = files(&here.join("results/whole"));
    usar(here, &["cluster", "merge", parts[0], parts[1], "--out", "results/whole"]);
    assert!(files(&here.join("results/whole")) == before);
}

#[test]
fn a_shard_has_whole_pairs_and_calls_itself_complete() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, "sweep short.ron --policies RNE,DIS --trials 5 --shard 2/2"));
    let shard = here.join("results/paper-2-of-2");
    let manifest: Value = serde_json::from_str(&read(&shard.join("manifest.json"))).unwrap();
    assert_eq!(manifest["is_complete"], true);
    let names: Vec<String> = files(&shard).into_keys().collect();
    let expected = [
        "columns.md",
        "datapackage.json",
        "experiment.ron",
        "journal.jsonl.gz",
        "manifest.json",
        "resolved.ron",
        "sweep.ron",
        "trials.csv",
    ];
    assert_eq!(names, expected, "the other tables are made when shards are merged");
    let said = succeeds(&usar(here, "compare results/paper-2-of-2 --metric distance --json"));
    let compared: Value = serde_json::from_str(&said).unwrap();
    let first = &compared["tables"]["comparisons"][0];
    assert_eq!((&first["n"], &first["missing"]), (&2.into(), &0.into()), "seeds 2 and 4, whole");
    succeeds(&usar(here, "report results/paper-2-of-2"));
    succeeds(&usar(here, "verify results/paper-2-of-2"));
}

#[test]
fn a_sweep_that_keeps_its_trials_only_is_compared_reported_verified_and_joined() {
    let folder = place();
    let here = folder.path();
    let keep = ["sweep", "short.ron", "--policies", "RNE,DIS", "--trials", "3", "--keep", "trials"];
    succeeds(&usar(here, &[&keep[..], &["--out", "little"]].concat()));
    succeeds(&usar(here, "sweep short.ron --policies RNE,DIS --trials 3 --out much"));
    let [little, much] = ["little", "much"].map(|name| files(&here.join(name)));
    assert!(little["trials.csv"] == much["trials.csv"] && !little.contains_key("rounds.csv"));
    let journal = |files: &BTreeMap<String, Vec<u8>>| files["journal.jsonl.gz"].len();
    assert!(journal(&little) * 5 < journal(&much), "{} {}", journal(&little), journal(&much));
    for command in ["compare", "report", "verify"] {
        succeeds(&usar(here, &[command, "little"]));
    }
    for shard in ["1/2", "2/2"] {
        succeeds(&usar(here, &[&keep[..], &["--shard", shard]].concat()));
    }
    succeeds(&usar(here, "cluster merge results --out joined"));
    assert!(files(&here.join("joined")) == little);
    refused(here, 2, &[&keep[..6], &["--out", "little"]].concat(), &["--keep: trials there, groups now"]);
}
