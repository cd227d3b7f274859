//! One seed, one result: in any number of threads, in any surroundings, in a new process, and when it is
//! verified.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use crate::commands::paper_text;
use crate::support::{program, succeeds, usar};

/// A folder with `short.ron`: the paper's scenario, a minute long.
fn short() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let text = paper_text().replace("duration_s: 600.0", "duration_s: 60.0");
    std::fs::write(folder.path().join("short.ron"), text).unwrap();
    let sweep = "(name: \"paper\", scenario: \"short.ron\", policies: [\"RNE\", \"DIS\", \"ENG\", \"HP_DIS\"], trials: 10)";
    std::fs::write(folder.path().join("short.sweep.ron"), sweep).unwrap();
    folder
}

/// The files of a folder, by name.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let file = |entry: std::io::Result<std::fs::DirEntry>| {
        let path = entry.unwrap().path();
        (path.file_name().unwrap().to_str().unwrap().to_owned(), std::fs::read(path).unwrap())
    };
    std::fs::read_dir(folder).unwrap().map(file).collect()
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
        ".lock",
        "experiment.ron",
        "groups.csv",
        "hashes.csv",
        "journal.jsonl",
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
    succeeds(&usar(
        folder.path(),
        &["sweep", "short.ron", "--trials", "2", "--policies", "RNE,DIS", "--out", "done"],
    ));
    let verify = |more: &[&str]| usar(folder.path(), &[&["verify", "done"], more].concat());
    assert_eq!(succeeds(&verify(&[])), "4 of 4 trials match, step by step\n");
    assert_eq!(succeeds(&verify(&["--sample", "3"])), "3 of 3 trials (of 4) match, step by step\n");

    let table = folder.path().join("done/hashes.csv");
    let text = std::fs::read_to_string(&table).unwrap();
    let line = text.lines().find(|line| line.starts_with("DIS,2,1500,")).unwrap();
    let part = line.len() - 4 * 10 + 4; // "robots", the second of ten
    let other = if line.as_bytes()[part] == b'0' { "1" } else { "0" };
    let mut changed = line.to_owned();
    changed.replace_range(part..=part, other);
    std::fs::write(&table, text.replace(line, &changed)).unwrap();
    let output = verify(&[]);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr.contains("1 of 4 trials do not match"), "{stderr}");
    let where_ = "trial 2 of DIS (seed 2) differs first at step 1500 (30.00 s), in: robots";
    assert!(stderr.contains(where_), "{stderr}");

    std::fs::remove_file(&table).unwrap();
    let output = verify(&[]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("is not the folder of a finished sweep"));
}

#[test]
fn a_trial_goes_on_from_a_snapshot_in_a_new_process() {
    let folder = short();
    let run = |arguments: &[&str]| usar(folder.path(), &[&["run", "short.ron"], arguments].concat());
    let whole = succeeds(&run(&["--policy", "DIS", "--seed", "5", "--json"]));
    for seconds in ["0", "17.3", "60"] {
        let file = format!("{seconds}.snapshot");
        let saved = run(&["--policy", "DIS", "--seed", "5", "--json", "--save", &file, "--save-at", seconds]);
        assert_eq!(succeeds(&saved), whole);
        assert_eq!(succeeds(&run(&["--from", &file, "--json"])), whole);
    }
    let refused = |arguments: &[&str], message: &str| {
        let output = run(arguments);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr.contains(message), "{stderr}");
    };
    refused(&["--save", "0.snapshot", "--save-at", "1"], "0.snapshot exists; nothing was overwritten");
    refused(&["--save", "x", "--save-at", "61"], "--save-at: must be from 0 to 60 s, found 61");
    refused(&["--from", "short.ron"], "short.ron: is not a snapshot of a trial");
    let mut bytes = std::fs::read(folder.path().join("17.3.snapshot")).unwrap();
    std::fs::write(folder.path().join("cut"), &bytes[..bytes.len() - 1]).unwrap();
    refused(&["--from", "cut"], "cut: should have ");
    bytes[8] += 1;
    std::fs::write(folder.path().join("later"), &bytes).unwrap();
    refused(&["--from", "later"], "later: is a snapshot of format 4; this program reads format 3");
}
