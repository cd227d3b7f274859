//! Exports, events and stories from the command line.

use serde_json::Value;

use crate::commands::refused;
use crate::support::{read, root, succeeds, usar};

fn scenario() -> String {
    root().join("scenarios/minimal/head_on.ron").display().to_string()
}

#[test]
fn a_trial_is_exported_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| usar(folder.path(), arguments);
    for (form, out) in [("mcap", "a.mcap"), ("csv", "t"), ("parquet", "p")] {
        let export = ["export", form, &scenario(), "--every", "1", "--out", out];
        assert_eq!(succeeds(&run(&export)), format!("{out}\n"));
    }
    assert!(std::fs::read(folder.path().join("a.mcap")).unwrap().starts_with(b"\x89MCAP0\r\n"));
    for name in ["robots", "groups", "events", "decisions"] {
        let parquet = std::fs::read(folder.path().join(format!("p/{name}.parquet"))).unwrap();
        assert!(parquet.starts_with(b"PAR1") && parquet.ends_with(b"PAR1"));
    }
    let robots = read(&folder.path().join("t/robots.csv"));
    assert!(robots.starts_with("time_s,robot,role,"));
    assert_eq!(robots.lines().nth(3).map(|line| line.split(',').next()), Some(Some("1")));
    let again = run(&["export", "csv", &scenario(), "--out", "t"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("--out: t is not empty; nothing was written"));
    succeeds(&run(&["export", "csv", &scenario(), "--out", "t", "--force"]));
    refused(&["export", "csv", &scenario()], "required arguments were not provided");
    refused(&["export", "mcap", &scenario(), "--out", "no/a.mcap"], "--out: there is no folder no");
}

#[test]
fn a_small_trial_tells_its_story_and_every_event_has_its_time() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| usar(folder.path(), arguments);
    let said = succeeds(&run(&["run", &scenario(), "--events", "e.jsonl"]));
    let story: Vec<&str> = said.lines().skip_while(|line| !line.starts_with("At ")).collect();
    assert!(story.iter().any(|line| line.contains("robot 1 makes room for robot 0, for ")), "{said}");
    assert!(story.iter().any(|line| line.contains("robots 0 and 1 meet")), "{said}");
    assert!(story.iter().any(|line| line.ends_with("robot 0 has arrived.")), "{said}");
    assert!(story.iter().all(|line| line.chars().count() <= 80), "{said}");
    let lines = read(&folder.path().join("e.jsonl"));
    let events: Vec<Value> = lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let times: Vec<f64> = events.iter().map(|event| event["time_s"].as_f64().unwrap()).collect();
    assert!(times.is_sorted() && times.len() > 5, "{lines}");
    let kinds: Vec<&str> = events.iter().map(|event| event["event"].as_str().unwrap()).collect();
    assert_eq!(kinds.iter().filter(|kind| **kind == "errand_done").count(), 2, "{lines}");
    assert_eq!(kinds.last(), Some(&"errands_over"));
    let again = run(&["run", &scenario(), "--events", "e.jsonl"]);
    assert_eq!(again.status.code(), Some(2));
    assert_eq!(read(&folder.path().join("e.jsonl")), lines);
    // A mission is too long for a story, and the JSON output has none.
    let paper = root().join("scenarios/paper.ron").display().to_string();
    let said = succeeds(&run(&["run", &paper, "--set", "duration_s=5"]));
    assert!(!said.lines().any(|line| line.starts_with("At ")), "{said}");
    succeeds(&run(&["run", &scenario(), "--json"])).parse::<Value>().unwrap();
}

#[test]
fn parquet_files_of_a_sweep_belong_to_it_and_are_verified() {
    let folder = tempfile::tempdir().unwrap();
    let paper = root().join("scenarios/paper.ron").display().to_string();
    let sweep = |more: &[&str]| {
        let first = ["sweep", &paper, "--set", "duration_s=5", "--quiet", "--policies", "RNE", "--out", "r"];
        usar(folder.path(), &[&first[..], more].concat())
    };
    let path = |name: &str| folder.path().join("r").join(name);
    let plain = succeeds(&sweep(&["--trials", "2"]));
    let manifest = read(&path("manifest.json"));
    assert_eq!(succeeds(&sweep(&["--trials", "2", "--tables", "parquet"])), plain);
    assert_eq!(read(&path("manifest.json")), manifest, "Parquet files are no part of the results");
    for name in ["trials", "rounds", "groups", "robots", "series", "hashes"] {
        assert!(path(&format!("{name}.parquet")).exists(), "{name}");
    }
    succeeds(&usar(folder.path(), "verify r --quiet"));
    let whole = std::fs::read(path("robots.parquet")).unwrap();
    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 1;
    std::fs::write(path("robots.parquet"), &flipped).unwrap();
    let verified = usar(folder.path(), "verify r --quiet");
    assert_eq!(verified.status.code(), Some(1));
    assert!(
        String::from_utf8_lossy(&verified.stderr).contains("robots.parquet: is not what robots.csv gives")
    );
    succeeds(&sweep(&["--trials", "2", "--tables", "parquet"]));
    assert_eq!(std::fs::read(path("robots.parquet")).unwrap(), whole);
    // The old Parquet files would have fewer trials.
    succeeds(&sweep(&["--trials", "3"]));
    assert!(!path("robots.parquet").exists());
    succeeds(&sweep(&["--trials", "3", "--tables", "parquet"]));
    succeeds(&sweep(&["--trials", "3", "--fresh"]));
    assert!(!path("trials.parquet").exists());
}
