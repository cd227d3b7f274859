//! A sweep on a cluster: its job script, and that the merged sweep has the bytes of a single run. `sbatch` is
//! a script here; .ci/slurm does the same with Slurm itself.

use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Output};

use crate::altered_results::files;
use crate::place::{place, refused};
use crate::support::{read, root, succeeds, usar};

/// Of trials that are long enough for a task to be killed after its first one.
const SWEEP: [&str; 7] = ["short.ron", "--policies", "RNE,DIS", "--trials", "20", "--set", "duration_s=600"];

/// Runs a line of a shell with the script as `sbatch`.
fn with_slurm(here: &Path, line: &str, more: &[(&str, &str)]) -> Output {
    let bin = here.join("bin");
    if !bin.exists() {
        std::fs::create_dir(&bin).unwrap();
        symlink(root().join("crates/usar/tests/suite/fake_sbatch"), bin.join("sbatch")).unwrap();
    }
    let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap());
    let mut command = Command::new("bash");
    command.args(["-c", line]).current_dir(here).env("PATH", path).envs(more.iter().copied());
    command.output().unwrap()
}

fn submit<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["cluster", "submit"], &SWEEP[..], more].concat()
}

#[test]
fn a_sweep_on_a_cluster_goes_on_after_kills_and_has_the_bytes_of_a_single_run() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, &[&["sweep"], &SWEEP[..], &["--out", "alone"]].concat()));
    let said = succeeds(&usar(here, &submit(&["--shards", "4"])));
    assert!(
        said.contains("results/paper-shards/job.sh: 4 shards of up to 10 trials; to submit them:"),
        "{said}"
    );
    let line = said.lines().last().unwrap();
    let shards = here.join("results/paper-shards");
    let log = || read(&shards.join("logs/merge.log"));
    succeeds(&with_slurm(here, line, &[("FAKE_KILLED", "2"), ("FAKE_LOST", "4")]));
    assert!(!here.join("results/paper").exists(), "{}", log());
    let merged = log();
    assert!(merged.contains("error: shard 2/4, 4/4: missing trials, "), "{merged}");
    let [first, place] = ["1/sweep.ron", "4"].map(|name| shards.join(name).display().to_string());
    assert!(merged.contains(&format!("\n  usar sweep {first} --shard 4/4 --out {place}\n")), "{merged}");
    // The same line again runs what is missing.
    succeeds(&with_slurm(here, line, &[]));
    assert!(log().contains("report.html"), "{}", log());
    let mut whole = files_only(&here.join("results/paper"));
    whole.retain(|name, _| name != "report.html" && name != "report.files");
    assert!(whole == files_only(&here.join("alone")), "its bytes are those of a single run");
    refused(here, 2, &submit(&["--shards", "4"]), &["results/paper-shards exists; nothing was written"]);
}

/// The files of a folder, but not the folders in it.
fn files_only(folder: &Path) -> std::collections::BTreeMap<String, Vec<u8>> {
    let _ = std::fs::remove_dir_all(folder.join("plots"));
    files(folder)
}

#[test]
fn a_job_script_has_the_options_of_the_sweep_and_of_sbatch() {
    let folder = place();
    let here = folder.path();
    let more = ["--shards", "3", "--set", "dt_s=0.02", "--", "--account=robots", "--time=01:00:00"];
    let said = succeeds(&usar(here, &submit(&more)));
    assert!(said.contains("$(sbatch --parsable --array=1-3 "), "{said}");
    let script = read(&here.join("results/paper-shards/job.sh"));
    for line in ["#SBATCH --job-name=paper", "#SBATCH --requeue", "#SBATCH --account=robots --time=01:00:00"]
    {
        assert!(script.lines().any(|found| found == line), "{line}: {script}");
    }
    let chosen = "short.ron --policies RNE,DIS --trials 20 --set duration_s=600 --set dt_s=0.02 \\";
    assert!(script.contains(chosen), "{script}");
    assert!(script.contains(said.lines().last().unwrap()), "{script}");
    assert!(script.lines().count() < 25, "{script}");
    let wrong = ["--shards", "2", "--out", "w", "--", "--comment=a b"];
    refused(here, 2, &submit(&wrong), &["must be one word without quotes and #, found \"--comment=a b\""]);
    let many = "--shards: must be at most 20, the seeds of all cases, found 21";
    refused(here, 2, &submit(&["--shards", "21", "--out", "w"]), &[many]);
    assert!(!here.join("w-shards").exists());
}

#[test]
fn the_commands_of_a_merge_run_the_shards_that_are_missing() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, &[&["sweep"], &SWEEP[..], &["--shard", "1/2", "--check"]].concat()));
    let merge = "cluster merge results --out whole";
    let said = String::from_utf8_lossy(&usar(here, merge).stderr).into_owned();
    let command = "usar sweep results/paper-1-of-2/sweep.ron --shard 2/2 --check --out results/2";
    assert!(said.contains("error: shard 2/2: missing trials, 20: trial 2 of RNE, "), "{said}");
    assert!(said.lines().last() == Some(&format!("  {command}")), "{said}");
    succeeds(&usar(here, &command.split(' ').skip(1).collect::<Vec<_>>()));
    succeeds(&usar(here, merge));
}

#[test]
fn shards_of_different_sweeps_and_damaged_ones_are_not_merged() {
    let folder = place();
    let here = folder.path();
    let sweep = |more: &str, shard: &str, out: &str| {
        succeeds(&usar(
            here,
            &format!("sweep short.ron --policies RNE,DIS --trials 4 {more} --shard {shard} --out {out}")
                .split_whitespace()
                .collect::<Vec<_>>(),
        ));
    };
    sweep("", "1/2", "shards/1");
    sweep("--set duration_s=31", "2/2", "shards/2");
    let merge = "cluster merge shards --out whole";
    let other = ["shards/1 and shards/2 are not of one sweep", "duration_s: 30.0 there, 31.0 now"];
    refused(here, 2, merge, &other);
    std::fs::remove_dir_all(here.join("shards/2")).unwrap();
    sweep("", "2/2", "shards/2");
    let archive = here.join("shards/2/journal.jsonl.gz");
    let mut bytes = std::fs::read(&archive).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&archive, bytes).unwrap();
    let damage = "shards/2: these files do not have the checksums of the manifest: journal.jsonl.gz";
    refused(here, 2, merge, &[damage]);
}
