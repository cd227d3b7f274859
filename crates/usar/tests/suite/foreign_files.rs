//! Files that do not belong to the program: files of other owners, links, pipes and devices. Also events
//! from outside: signals, and a stderr that cannot be written.

use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::altered_results::{files, journal};
use crate::place::{place, refused};
use crate::support::{program, read, succeeds, usar};

const SWEEP: [&str; 6] = ["sweep", "short.ron", "--policies", "RNE,DIS", "--trials", "2"];

#[test]
fn starting_over_and_reporting_leave_the_files_of_others_alone() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, &SWEEP));
    let results = here.join("results/paper");
    let fresh = [&SWEEP[..], &["--fresh"]].concat();

    std::fs::write(results.join("report.html"), "mine").unwrap();
    let message = "report.html: is not of a report of this program; nothing was overwritten";
    refused(here, 2, "report results/paper", &[message]);
    refused(here, 2, &fresh, &["has files that are not the sweep's: report.html; nothing was deleted"]);
    std::fs::remove_file(results.join("report.html")).unwrap();

    succeeds(&usar(here, "report results/paper"));
    succeeds(&usar(here, "report results/paper"));
    std::fs::write(results.join("plots/mine.svg"), "mine").unwrap();
    refused(here, 2, &fresh, &["has files that are not the sweep's: plots/mine.svg"]);
    std::fs::write(results.join("notes.txt"), "mine").unwrap();
    refused(here, 2, &fresh, &["notes.txt, plots/mine.svg; nothing was deleted"]);
    std::fs::remove_file(results.join("notes.txt")).unwrap();
    std::fs::remove_file(results.join("plots/mine.svg")).unwrap();
    succeeds(&usar(here, &fresh));
    assert!(!results.join("plots").exists() && !results.join("report.html").exists());

    for name in ["sweep.ron", "experiment.ron"] {
        let own = here.join("own");
        std::fs::create_dir_all(&own).unwrap();
        std::fs::write(own.join(name), "mine").unwrap();
        let arguments = [&SWEEP[..], &["--out", "own"]].concat();
        refused(here, 2, &arguments, &["is not empty and not the folder of a sweep"]);
        assert_eq!(read(&own.join(name)), "mine");
        std::fs::remove_dir_all(&own).unwrap();
    }
}

#[test]
fn no_link_is_followed_out_of_a_folder_of_results() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, &SWEEP));
    let results = here.join("results/paper");
    let outside = here.join("outside");
    std::fs::create_dir(&outside).unwrap();
    std::fs::write(outside.join("a.svg"), "mine").unwrap();
    std::fs::write(outside.join("table"), "mine").unwrap();

    symlink(&outside, results.join("plots")).unwrap();
    refused(here, 2, "report results/paper", &["plots: is not a folder"]);
    refused(here, 2, &[&SWEEP[..], &["--fresh"]].concat(), &["not the sweep's: plots"]);
    std::fs::remove_file(results.join("plots")).unwrap();

    for name in ["trials.csv.new", "manifest.json.new", "journal.jsonl.new"] {
        symlink(outside.join("table"), results.join(name)).unwrap();
    }
    let more = ["sweep", "short.ron", "--policies", "RNE,DIS", "--trials", "3"];
    succeeds(&usar(here, &more));
    std::fs::remove_file(results.join("journal.jsonl.gz")).unwrap();
    symlink(outside.join("table"), results.join("journal.jsonl.gz")).unwrap();
    refused(here, 3, &more, &["journal.jsonl.gz: is not a regular file"]);
    std::fs::remove_file(results.join("journal.jsonl.gz")).unwrap();
    symlink(outside.join("table"), results.join("journal.jsonl")).unwrap();
    refused(here, 3, &more, &["journal.jsonl: is not a regular file"]);
    assert_eq!(read(&outside.join("table")), "mine");
    assert_eq!(files(&outside).len(), 2);
}

#[test]
fn a_pipe_among_the_results_is_not_waited_for() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, &SWEEP));
    let pipe = |name: &str| {
        let path = here.join("results/paper").join(name);
        std::fs::remove_file(&path).unwrap();
        assert!(Command::new("mkfifo").arg(&path).status().unwrap().success());
        path
    };
    let path = pipe("robots.csv");
    let said = usar(here, "compare results/paper");
    assert!(String::from_utf8_lossy(&said.stderr).contains("checksums of the manifest: robots.csv"));
    succeeds(&usar(here, &SWEEP));
    assert!(path.is_file(), "it is made again");
    pipe("journal.jsonl.gz");
    let said = usar(here, "compare results/paper");
    assert!(String::from_utf8_lossy(&said.stderr).contains("checksums of the manifest: journal.jsonl.gz"));
}

#[test]
fn a_byte_after_the_last_line_of_a_journal_is_taken_away() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, &SWEEP));
    let results = here.join("results/paper");
    let sound = files(&results);
    let journal = "journal.jsonl.gz";
    std::fs::write(results.join(journal), [&sound[journal][..], b"x"].concat()).unwrap();
    succeeds(&usar(here, &SWEEP));
    assert!(files(&results) == sound, "the sweep's command mends it");
    succeeds(&usar(here, "verify results/paper"));
}

/// Starts a long sweep, and waits until it has trials.
fn begun(here: &Path) -> std::process::Child {
    let mut command = Command::new(program());
    command.args(["sweep", "short.ron", "--trials", "5000", "--policies", "RNE", "--jobs", "1"]);
    let child = command.current_dir(here).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    while journal(&here.join("results/paper")).lines().count() < 2 {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    child
}

#[test]
fn a_sweep_that_is_told_to_end_says_so_and_leaves_a_whole_journal() {
    for (signal, status) in [("TERM", 143), ("HUP", 129), ("INT", 130)] {
        let folder = place();
        let child = begun(folder.path());
        let id = child.id().to_string();
        assert!(Command::new("kill").args([&format!("-{signal}"), &id]).status().unwrap().success());
        let output = child.wait_with_output().unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{stderr}");
        assert!(stderr.contains("the same command goes on"), "{stderr}");
        let journal = read(&folder.path().join("results/paper/journal.jsonl"));
        assert!(journal.ends_with("}\n"));
    }
}

#[test]
fn a_sweep_whose_stderr_takes_nothing_runs_all_the_same() {
    let folder = place();
    let here = folder.path();
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let mut sweep = Command::new(program());
    let sweep = sweep.args(SWEEP).current_dir(here).stderr(full).stdout(Stdio::null());
    assert_eq!(sweep.status().unwrap().code(), Some(0));
    let closed = format!("exec '{}' {} --out closed 2>&-", program().display(), SWEEP.join(" "));
    let status = Command::new("sh").args(["-c", &closed]).current_dir(here).stdout(Stdio::null()).status();
    assert_eq!(status.unwrap().code(), Some(0));
    assert!(files(&here.join("results/paper")) == files(&here.join("closed")));
}

#[test]
fn one_trial_takes_no_longer_than_it_may_and_a_disk_that_refuses_is_told_as_such() {
    let folder = place();
    let here = folder.path();
    let message = "the trial took longer than 0 s and had come to 1 s of simulated time; --max-trial-s";
    refused(here, 1, "run short.ron --max-trial-s 0", &[message]);
    let arguments = ["run", "short.ron", "--save", "/proc/x.snapshot", "--save-at", "1"];
    refused(here, 3, &arguments, &["cannot write /proc/x.snapshot"]);
}

#[test]
fn names_do_not_command_the_terminal() {
    let folder = place();
    let output = usar(folder.path(), &["check", "a\u{1b}]0;title\u{7}.ron"]);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(stderr.contains("a\\u{1b}]0;title\\u{7}.ron"), "{stderr}");
    assert!(!stderr.contains('\u{1b}'));
}
