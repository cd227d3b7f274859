//! Recordings and pages: the files written, refusals, and that results stay the same.

use std::path::Path;

use recording::Recording;
use serde_json::Value;

use crate::commands::refused;
use crate::support::{read, root, succeeds, usar};

fn scenario() -> String {
    root().join("scenarios/minimal/head_on.ron").display().to_string()
}

fn recording(path: &Path) -> Recording {
    Recording::read(&std::fs::read(path).unwrap()).unwrap()
}

#[test]
fn a_trial_is_recorded_with_the_same_result_and_nothing_is_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let alone = succeeds(&usar(folder.path(), &["run", &scenario(), "--json"]));
    let arguments = ["run", &scenario(), "--json", "--record", "a.usrec", "--record-fps", "5"];
    assert_eq!(succeeds(&usar(folder.path(), &arguments)), alone);
    let recording = recording(&folder.path().join("a.usrec"));
    assert_eq!(recording.header.steps_per_frame, 10);
    let alone: Value = serde_json::from_str(&alone).unwrap();
    assert_eq!(Value::from(recording.summary.unwrap().state_hash), alone["state_hash"]);
    let again = usar(folder.path(), &arguments);
    assert_eq!(again.status.code(), Some(2));
    assert!(
        String::from_utf8_lossy(&again.stderr).contains("--record: a.usrec exists; nothing was overwritten")
    );
}

#[test]
fn a_page_has_its_recordings_in_it_and_replaces_nothing_but_a_page() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| usar(folder.path(), arguments);
    succeeds(&run(&["run", &scenario(), "--record", "a.usrec"]));
    assert_eq!(succeeds(&run(&["view", "a.usrec", "--no-open"])), "a.html\n");
    succeeds(&run(&["view", "a.usrec", &scenario(), "--no-open", "--out", "a.html"]));
    let page = read(&folder.path().join("a.html"));
    assert_eq!(page.matches("<script type=\"application/x-usrec\"").count(), 2);
    assert!(
        page.contains("Content-Security-Policy") && !page.contains("http://") && !page.contains("https://")
    );
    std::fs::write(folder.path().join("notes.html"), "mine").unwrap();
    let other = run(&["view", "a.usrec", "--no-open", "--out", "notes.html"]);
    assert_eq!(other.status.code(), Some(2));
    assert_eq!(read(&folder.path().join("notes.html")), "mine");
}

#[test]
fn the_state_at_a_time_is_told_as_json() {
    let folder = tempfile::tempdir().unwrap();
    let said = succeeds(&usar(folder.path(), &["view", &scenario(), "--at", "3.25"]));
    let said: Value = serde_json::from_str(&said).unwrap();
    assert_eq!((said["frame"].as_u64(), said["time_s"].as_f64()), (Some(32), Some(3.2)));
    assert_eq!(said["robots"][0]["activity"], "on_errand");
    let millimetres = &said["state"]["robots"][0]["motion"]["position_mm"];
    for (axis, field) in ["x_m", "y_m"].into_iter().enumerate() {
        let metres = said["robots"][0][field].as_f64().unwrap();
        assert_eq!(Some((metres * 1000.0).round()), millimetres[axis].as_f64());
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn trials_of_a_sweep_are_recorded_and_shown() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| usar(folder.path(), arguments);
    let paper = root().join("scenarios/paper.ron").display().to_string();
    let sweep =
        ["sweep", &paper, "--set", "duration_s=40", "--policies", "RNE,x=RNE(score: Sum)", "--trials", "2"];
    let sweep = |more: &[&str]| run(&[&sweep[..], &["--quiet", "--out", "r"], more].concat());
    let plain = succeeds(&sweep(&[]));
    let hashes = read(&folder.path().join("r/hashes.csv"));
    assert_eq!(succeeds(&sweep(&["--recordings", "seeds=2"])), plain);
    let path = folder.path().join("r/recordings/x-2.usrec");
    let recorded = recording(&path);
    assert_eq!((recorded.header.seed, recorded.header.policy.as_str()), (2, "x"));
    assert!(hashes.contains(&recorded.summary.unwrap().state_hash));
    assert!(!folder.path().join("r/recordings/x-1.usrec").exists());
    succeeds(&run(&["verify", "r"]));
    // One trial comes from its recording, the other is simulated again.
    succeeds(&run(&["view", "r", "--seed", "2", "--policy", "x,RNE", "--no-open", "--out", "two.html"]));
    succeeds(&run(&["view", "r", "--seed", "1", "--no-open", "--out", "one.html"]));
    // One page has all recorded trials; without recordings, those with the seed that is asked for.
    let replays = |more: &[&str]| {
        succeeds(&run(&[&["view", "r", "--with-replays", "--no-open", "--out", "all.html"], more].concat()));
        let page = read(&folder.path().join("all.html"));
        let names = page.split("data-name=\"").skip(1).map(|rest| rest.split('"').next().unwrap().to_owned());
        names.collect::<Vec<_>>()
    };
    assert_eq!(replays(&[]), ["RNE-2", "x-2"]);
    assert_eq!(replays(&["--seed", "1"]), ["RNE-1", "x-1"]);
    assert_eq!(replays(&["--policy", "x"]), ["x-2"]);
    refused(&["view", &paper, "--with-replays"], "is no folder of a sweep");
    // A recording of another trial is replaced, and all recordings are deleted when the sweep starts over.
    std::fs::copy(&path, folder.path().join("r/recordings/x-1.usrec")).unwrap();
    succeeds(&sweep(&["--recordings", "1"]));
    assert_eq!(self::recording(&folder.path().join("r/recordings/x-1.usrec")).header.seed, 1);
    succeeds(&sweep(&["--fresh"]));
    assert!(!folder.path().join("r/recordings").exists());
    // A trial that the sweep does not have is simulated, as anywhere else.
    succeeds(&run(&["view", "r", "--seed", "9", "--policy", "DIS", "--no-open", "--out", "nine.html"]));
}

#[test]
fn files_that_cannot_be_shown_are_refused_in_one_sentence() {
    refused("view nothing.usrec", "nothing.usrec: cannot be read");
    refused(&["run", &scenario(), "--record", "a.usrec", "--record-fps", "0"], "must be a number from 0.01");
    refused(
        &["sweep", &scenario(), "--recordings", "some"],
        "must be `all`, a number of trials, or `seeds=`",
    );
    let folder = tempfile::tempdir().unwrap();
    let refuses = |bytes: &[u8], reason: &str| {
        std::fs::write(folder.path().join("a.usrec"), bytes).unwrap();
        let output = usar(folder.path(), "view a.usrec --no-open");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && said.contains(reason), "{reason}: {said}");
    };
    succeeds(&usar(folder.path(), "run paper --set duration_s=60 --record whole.usrec --quiet"));
    let whole = std::fs::read(folder.path().join("whole.usrec")).unwrap();
    let middle = whole.len() / 2;
    refuses(&whole[..100], "a.usrec: ends within its header");
    let mut flipped = whole.clone();
    flipped[middle] ^= 4;
    refuses(&flipped, "a.usrec: is damaged: chunk");
    std::fs::write(folder.path().join("a.usrec"), &whole[..middle]).unwrap();
    let output = usar(folder.path(), "view a.usrec --no-open");
    assert!(String::from_utf8_lossy(&output.stderr).contains("was cut short"));
    succeeds(&output);
}

/// Its questions are of version 2, before levels had names.
#[test]
fn a_recording_of_old_questions_is_refused_with_what_changed() {
    let path = root().join("viewer/test/small.usrec").display().to_string();
    refused(
        &["view", &path, "--at", "12.3"],
        "schema_version must be 3, found 2; since version 3, levels stand in",
    );
}
