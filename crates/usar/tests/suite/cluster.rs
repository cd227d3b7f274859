//! A sweep on a cluster: its submission, its progress, and that the merged sweep has the bytes of a single
//! run. `sbatch` is a script here; .ci/slurm does the same with Slurm itself.

use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;
use xtask::kills::files;

use crate::place::{place, refused};
use crate::support::{program, read, root, succeeds, usar};

/// Of trials that are long enough for a task to be killed after its first one.
const SWEEP: [&str; 7] = ["short.ron", "--policies", "RNE,DIS", "--trials", "20", "--set", "duration_s=600"];

/// Runs a command with the script as `sbatch`.
fn with_slurm(here: &Path, command: &mut Command, more: &[(&str, &str)]) -> Output {
    let bin = here.join("bin");
    if !bin.exists() {
        std::fs::create_dir(&bin).unwrap();
        symlink(root().join("crates/usar/tests/suite/fake_sbatch"), bin.join("sbatch")).unwrap();
    }
    let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap());
    command.current_dir(here).env("PATH", path).envs(more.iter().copied()).output().unwrap()
}

fn submit<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["cluster", "submit"], &SWEEP[..], &["--cpus", "2"], more].concat()
}

fn status(here: &Path) -> Value {
    serde_json::from_str(&succeeds(&usar(here, "cluster status results/paper-shards --json"))).unwrap()
}

#[test]
fn a_sweep_on_a_cluster_goes_on_after_kills_and_has_the_bytes_of_a_single_run() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, &[&["sweep"], &SWEEP[..], &["--out", "alone"]].concat()));
    let troubles = [("FAKE_KILLED", "2"), ("FAKE_LOST", "4")];
    let mut command = Command::new(program());
    let said = succeeds(&with_slurm(here, command.args(submit(&["--shards", "4"])), &troubles));
    assert!(said.starts_with("4 shards: each up to 10 trials, about "), "{said}");
    assert!(said.contains("submitted: array 1, and after it 2, which writes "), "{said}");
    assert!(!here.join("results/paper").exists(), "the job after it waits for all");
    let before = status(here);
    let states: Vec<&str> =
        before["shards"].as_array().unwrap().iter().map(|shard| shard["state"].as_str().unwrap()).collect();
    assert_eq!(states, ["done", "lost", "done", "lost"]);
    let finished = before["finished"].as_u64().unwrap();
    assert!((21..30).contains(&finished), "two shards and a part of the second: {finished}");
    // The printed command submits the missing tasks, and the merge.
    let shown = succeeds(&usar(here, "cluster status results/paper-shards"));
    let line = shown.lines().last().unwrap();
    assert!(line.contains("--array=2,4%4 "), "{line}");
    let output = with_slurm(here, Command::new("bash").args(["-c", line]), &[]);
    succeeds(&output);
    assert_eq!(status(here)["finished"], 40);
    assert!(read(&here.join("results/paper-shards/logs/merge.log")).contains("report.html"));
    let mut whole = files_only(&here.join("results/paper"));
    whole.retain(|name, _| name != "report.html" && name != "report.files");
    assert!(whole == files_only(&here.join("alone")), "its bytes are those of a single run");
    refused(here, 2, &submit(&["--shards", "4"]), &["results/paper-shards exists; nothing was submitted"]);
}

/// The files of a folder, but not the folders in it.
fn files_only(folder: &Path) -> std::collections::BTreeMap<String, Vec<u8>> {
    let _ = std::fs::remove_dir_all(folder.join("plots"));
    files(folder)
}

#[test]
fn a_dry_run_prints_readable_scripts_and_writes_nothing() {
    let folder = place();
    let here = folder.path();
    let before = std::fs::read_dir(here).unwrap().count();
    let said = succeeds(&usar(
        here,
        &submit(&[
            "--dry-run",
            "--account",
            "robots",
            "--partition",
            "short",
            "--time",
            "01:00:00",
            "--set",
            "dt_s=0.02",
        ]),
    ));
    for line in [
        "#SBATCH --array=1-1%1",
        "#SBATCH --requeue",
        "#SBATCH --signal=B:INT@60",
        "#SBATCH --cpus-per-task=2",
        "#SBATCH --time=01:00:00",
        "#SBATCH --account=robots",
        "#SBATCH --partition=short",
    ] {
        assert!(said.lines().any(|found| found == line), "{line}: {said}");
    }
    assert!(
        said.contains("short.ron --policies RNE,DIS --trials 20 --set duration_s=600 --set dt_s=0.02 \\"),
        "{said}"
    );
    assert!(said.contains("nothing was written or submitted"), "{said}");
    assert_eq!(std::fs::read_dir(here).unwrap().count(), before);
    std::fs::write(here.join("mine.sh"), "#!/bin/bash\n@uasr@ sweep @arguments@\n").unwrap();
    refused(
        here,
        2,
        &submit(&["--dry-run", "--template", "mine.sh"]),
        &["--template: line 2: @uasr@ must be one of @name@"],
    );
    refused(here, 2, &submit(&["--account", "a b"]), &["must be letters, digits and -_.:, found \"a b\""]);
    let mut command = Command::new(program());
    let output = command.args(submit(&[])).current_dir(here).env("PATH", here).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(1) && said.contains("--dry-run prints the scripts"), "{said}");
    assert!(!here.join("results").join("paper-shards").exists());
}

#[test]
fn shards_that_were_run_by_hand_have_a_status_too() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, &[&["sweep"], &SWEEP[..], &["--shard", "1/2"]].concat()));
    let said = succeeds(&usar(here, "cluster status results"));
    assert!(said.starts_with("shards  2: 1 done, 1 lost\ntrials  20 of 40\n"), "{said}");
    let own = std::fs::read_dir(here.join("results")).unwrap().next().unwrap().unwrap().path();
    let own = own.strip_prefix(here).unwrap();
    let command = format!("usar sweep {}/sweep.ron --shard 2/2 --out results/2", own.display());
    assert!(said.contains(&format!("not started; to run it: {command}")), "{said}");
    let said = succeeds(&usar(here, &["cluster", "status", own.to_str().unwrap()]));
    assert!(said.starts_with("shards  1: 1 done\ntrials  20 of 20\n"), "{said}");
    // The command runs the shard, and then the command that merges is told.
    succeeds(&usar(here, &command.split(' ').skip(1).collect::<Vec<_>>()));
    let said = succeeds(&usar(here, "cluster status results"));
    assert!(said.ends_with("this merges them:\nusar cluster merge results --out results-merged\n"), "{said}");
    succeeds(&usar(here, "cluster merge results --out results-merged"));
    let said = succeeds(&usar(here, "cluster status results"));
    assert!(said.ends_with("trials  40 of 40\n"), "{said}");
    std::fs::create_dir(here.join("empty")).unwrap();
    refused(here, 2, "cluster status empty", &["has neither shards nor a sweep in it"]);
}

#[test]
fn status_believes_no_folder_that_a_merge_refuses() {
    let folder = place();
    let here = folder.path();
    let sweep = |more: &str, shard: &str, out: &str| {
        let words =
            format!("sweep short.ron --policies RNE,DIS --trials 4 {more} --shard {shard} --out {out}");
        let words: Vec<&str> = words.split_whitespace().collect();
        succeeds(&usar(here, &words));
    };
    sweep("", "1/2", "shards/1");
    sweep("--set duration_s=31", "2/2", "shards/2");
    let other = "shards/1 and shards/2 are not of one sweep: duration_s: 30.0 there, 31.0 now";
    let said = succeeds(&usar(here, "cluster status shards"));
    assert!(said.starts_with("shards  2: 1 done, 1 refused\ntrials  4 of 8\n"), "{said}");
    assert!(said.contains(&format!("  shard    2  refused  0 of 4 trials  {other}")), "{said}");
    refused(here, 2, "cluster merge shards --out whole", &["shards/1 and shards/2 are not of one sweep"]);

    std::fs::rename(here.join("shards/2"), here.join("shards/3")).unwrap();
    sweep("", "2/2", "shards/2");
    sweep("", "1/3", "shards/4");
    let said = succeeds(&usar(here, "cluster status shards"));
    assert!(said.starts_with("shards  4: 2 done, 2 refused\ntrials  8 of 8\n"), "{said}");
    assert!(said.contains("shards/4: is shard 1/3, and shards/1 is one of 2 shards"), "{said}");
    assert!(!said.contains("this merges them"), "{said}");

    std::fs::remove_dir_all(here.join("shards/3")).unwrap();
    std::fs::remove_dir_all(here.join("shards/4")).unwrap();
    let archive = here.join("shards/2/journal.jsonl.gz");
    let mut bytes = std::fs::read(&archive).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&archive, bytes).unwrap();
    let damage = "shards/2: these files do not have the checksums of the manifest: journal.jsonl.gz";
    let said = succeeds(&usar(here, "cluster status shards"));
    assert!(said.starts_with("shards  2: 1 done, 1 refused\n") && said.contains(damage), "{said}");
    refused(here, 2, "cluster merge shards --out whole", &[damage]);
}
