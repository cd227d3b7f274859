//! Folders of results that were changed, and disks that are full.

use std::process::Command;

use crate::altered_results::files;
use crate::place::{place, refused};
use crate::support::{program, succeeds, usar};

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
    damage("journal.jsonl.gz", flip);
    refused(here, 2, "compare results/paper", &["checksums of the manifest: journal.jsonl.gz"]);
    mended("journal.jsonl.gz: does not have the checksum");
    damage("journal.jsonl.gz", |bytes| bytes.truncate(bytes.len() - 100));
    refused(here, 2, "compare results/paper", &["checksums of the manifest: journal.jsonl.gz"]);
    mended("journal.jsonl.gz: does not have the checksum");
    damage("trials.csv", flip);
    refused(here, 2, "compare results/paper", &["trials.csv"]);
    mended("trials.csv: does not have the checksum");
    damage("hashes.csv", |bytes| bytes.truncate(bytes.len() / 2));
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
    succeeds(&usar(here, "sweep short.ron --policies RNE --trials 4 --out whole"));
    // A limit on the size of files acts like a full disk.
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
    succeeds(&usar(here, "sweep short.ron --policies RNE --trials 4"));
    assert!(
        files(&here.join("results/paper")) == files(&here.join("whole")),
        "it goes on when the cause is gone"
    );

    std::fs::write(here.join("file"), "").unwrap();
    refused(here, 3, "sweep short.ron --out file/results", &["cannot write to file/results"]);

    let text = "{\"host\":\"n17\",\"job\":\"42_3\",\"process\":99,\"since\":\"2026-01-01T00:00:00Z\"}\n";
    let path = here.join("results/paper/.lock");
    std::fs::write(&path, text).unwrap();
    let held = std::fs::File::open(&path).unwrap();
    held.lock().unwrap();
    refused(
        here,
        3,
        "sweep short.ron --policies RNE --trials 4",
        &[
            "results/paper: another process is at work in this folder",
            "process 99 on n17, job 42_3, since 2026-01-01T00:00:00Z",
        ],
    );
    drop(held);
    succeeds(&usar(here, "sweep short.ron --policies RNE --trials 4"));
    assert!(!path.exists(), "what a process has left stands in no way");
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
        refused(here, 2, "sweep short.ron --out results", message);
        refused(here, 2, "sweep short.ron --out results --fresh", message);
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
    refused(here, 2, "compare results/paper", &["manifest.json", "its checksum does not match"]);
    std::fs::write(results.join("manifest.json"), text("manifest.json")).unwrap();
    std::fs::write(results.join("journal.jsonl.gz"), []).unwrap();
    refused(
        here,
        2,
        "compare results/paper",
        &["do not have the checksums of the manifest: journal.jsonl.gz"],
    );
    succeeds(&usar(here, &sweep));
    assert!(files(&results) == sound);
}
