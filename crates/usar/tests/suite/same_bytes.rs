//! One seed, one result: with any number of threads, in any environment, in a new process, and in
//! verification.

use std::path::Path;
use std::process::Command;

use experiments::experiment::Shard;

use crate::altered_results::{Forged, files};
use crate::commands::paper_text;
use crate::support::{program, succeeds, usar};

/// A folder with `short.ron`: the paper's scenario, a minute long.
fn short() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let text = paper_text().replace("duration_s: 600.0", "duration_s: 60.0");
    std::fs::write(folder.path().join("short.ron"), text).unwrap();
    let sweep = "(name: \"paper\", scenario: \"short.ron\", policies: \
        [\"RNE\", \"DIS\", \"ENG\", \"HP_DIS\"], trials: 10)";
    std::fs::write(folder.path().join("short.sweep.ron"), sweep).unwrap();
    folder
}

#[test]
fn a_sweep_writes_the_same_bytes_on_any_number_of_threads() {
    let folder = short();
    let sweep = |jobs: &str| {
        let arguments = ["sweep", "short.ron", "--trials", "3", "--jobs", jobs, "--out", jobs];
        (succeeds(&usar(folder.path(), &arguments)), files(&folder.path().join(jobs)))
    };
    let one = sweep("1");
    assert_eq!(one, sweep("2"));
    assert_eq!(one, sweep("8"));
    let names: Vec<&str> = one.1.keys().map(String::as_str).collect();
    let expected = [
        "columns.md",
        "datapackage.json",
        "experiment.ron",
        "groups.csv",
        "hashes.csv",
        "journal.jsonl.gz",
        "links.csv",
        "manifest.json",
        "resolved.ron",
        "robots.csv",
        "rounds.csv",
        "series.csv",
        "sweep.ron",
        "trials.csv",
    ];
    assert_eq!(names, expected);
    assert_eq!(csv::Reader::from_reader(&*one.1["trials.csv"]).records().count(), 12);
    let text = String::from_utf8(one.1["trials.csv"].clone()).unwrap().to_lowercase();
    assert!(!text.contains("nan") && !text.contains("inf"), "{text}");
}

#[test]
fn processor_features_locale_time_zone_and_folder_change_nothing() {
    let (here, there) = (short(), short());
    let sweep = |folder: &Path, surroundings: &[(&str, &str)]| {
        let mut command = Command::new(program());
        command.args(["sweep", "short.ron", "--trials", "1", "--policies", "RNE", "--check", "--out"]);
        let output = command.arg(surroundings.len().to_string()).envs(surroundings.iter().copied());
        succeeds(&output.current_dir(folder).output().unwrap());
        files(&folder.join(surroundings.len().to_string()))
    };
    let plain = sweep(here.path(), &[]);
    assert_eq!(plain, sweep(here.path(), &[("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-FMA")]));
    assert_eq!(plain, sweep(there.path(), &[("LC_ALL", "de_DE.UTF-8"), ("TZ", "Asia/Kathmandu")]));
}

#[test]
fn a_sweep_is_verified_and_the_first_difference_is_named() {
    let folder = short();
    succeeds(&usar(folder.path(), "sweep short.ron --trials 2 --policies RNE,DIS --out done"));
    let verify = |more: &[&str]| usar(folder.path(), &[&["verify", "done"], more].concat());
    let all = "match, step by step and number by number; every table is what they give\n";
    assert_eq!(succeeds(&verify(&[])), format!("4 of 4 trials {all}"));
    assert_eq!(succeeds(&verify(&["--sample", "3"])), format!("3 of 3 trials (of 4) {all}"));

    let refused = |what: &[&str]| {
        let output = verify(&[]);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{stderr}");
        what.iter().for_each(|what| assert!(stderr.contains(what), "{what}: {stderr}"));
    };
    let done = folder.path().join("done");
    let forged = Forged::of(&done);
    forged.line("\"policy\":\"DIS\",\"trial\":2,", |line| {
        let at = line.find("1500:").unwrap();
        let part = at + "1500:".len() + 32 + 1 + 4; // "robots", the second of ten
        let other = if line.as_bytes()[part] == b'0' { "1" } else { "0" };
        line.replace_range(part..=part, other);
    });
    refused(&[
        "1 of 4 trials do not match",
        "trial 2 of DIS (seed 2) differs first at step 1500 (30.00 s), in: robots",
    ]);

    forged.line("\"policy\":\"RNE\",\"trial\":1,", |line| {
        let at = line.find("\"rescued\":").unwrap() + "\"rescued\":".len();
        let end = at + line[at..].find([',', '}']).unwrap();
        line.replace_range(at..end, "9999");
    });
    refused(&[
        "trial 1 of RNE (seed 1) has the same states, but not the same numbers:",
        ".rescued is 9999 in the folder",
    ]);

    forged.file("trials.csv", |text| text.replacen("RNE,1,RNE,1,completed,", "RNE,1,RNE,1,completed,9", 1));
    refused(&["4 of 4 trials match", "trials.csv: is not what the trials in the journal give"]);

    forged.file("experiment.ron", |_| "garbage".to_owned());
    refused(&["4 of 4 trials match", "experiment.ron:1"]);

    forged.journal(|text| {
        let (first, rest) = text.split_once('\n').unwrap();
        format!("{rest}{first}\n")
    });
    refused(&["the journal: is not its trials in order"]);

    forged.restore();
    std::fs::remove_file(done.join("hashes.csv")).unwrap();
    refused(&["hashes.csv: is missing"]);
    forged.restore();
    succeeds(&verify(&[]));
    for (number, trials) in [("0", "0"), ("4294967295", "4294967295")] {
        forged.line("\"policy\":\"RNE\",\"trial\":1,", |line| {
            *line = line.replacen("\"trial\":1,", &format!("\"trial\":{number},"), 1);
        });
        refused(&[
            &format!("trial {trials} of RNE (seed 1) is not of this sweep"),
            "trial 1 of RNE (seed 1) cannot be read: ",
        ]);
    }
    forged.restore();
    forged.manifest(|manifest| manifest.files.clear());
    let output = verify(&[]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("it does not list the files of a sweep"));
    forged.manifest(|manifest| manifest.shard = Some(Shard { number: 1, of: 0 }));
    let output = verify(&[]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("it is of shard 1/0, which no sweep has"));
}

#[test]
fn a_trial_goes_on_from_a_snapshot_in_a_new_process() {
    let folder = short();
    let run = |arguments: &[&str]| usar(folder.path(), &[&["run", "short.ron"], arguments].concat());
    let whole = succeeds(&run(&["--policy", "DIS", "--seed", "5", "--json"]));
    for seconds in ["0", "17.34", "60"] {
        let file = format!("{seconds}.snapshot");
        let saved = run(&["--policy", "DIS", "--seed", "5", "--json", "--save", &file, "--save-at", seconds]);
        assert_eq!(succeeds(&saved), whole);
        assert_eq!(succeeds(&run(&["--resume", &file, "--json"])), whole);
    }
    let refused = |arguments: &[&str], message: &str| {
        let output = run(arguments);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr.contains(message), "{stderr}");
    };
    refused(&["--save", "0.snapshot", "--save-at", "1"], "0.snapshot exists; nothing was overwritten");
    refused(&["--save", "x", "--save-at", "61"], "--save-at: must be from 0 to 60 s, found 61");
    refused(&["--resume", "short.ron"], "short.ron: is not a snapshot of a trial");
    let mut bytes = std::fs::read(folder.path().join("17.34.snapshot")).unwrap();
    std::fs::write(folder.path().join("cut"), &bytes[..bytes.len() - 1]).unwrap();
    refused(&["--resume", "cut"], "cut: should have ");
    bytes[8] += 1;
    std::fs::write(folder.path().join("later"), &bytes).unwrap();
    refused(&["--resume", "later"], "later: is a snapshot of format 21; this program reads format 20");
}
