//! Results in which there is little or nothing: one trial, a policy without trials, one task, one robot, no
//! round, a sweep that was interrupted. Everything that reads them says so, soon and in little memory.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::place::place;
use crate::support::{program, read, succeeds, usar, usar_in};

/// Runs a command that may take 3 GB of addresses and a minute. Its exit status is 0, or 2 with a sentence.
/// Returns whether there was something to write.
#[track_caller]
fn comes_to_an_end(here: &Path, line: &str) -> bool {
    let limited = format!("ulimit -v 3000000; exec timeout 60 '{}' {line}", program().display());
    let output = Command::new("sh").args(["-c", &limited]).current_dir(here).output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!([Some(0), Some(2)].contains(&output.status.code()), "{line}: {:?} {stderr}", output.status);
    assert!(output.status.code() == Some(0) || stderr.contains("error: "), "{line}: {stderr}");
    assert!(!stderr.contains("internal error"), "{line}: {stderr}");
    output.status.code() == Some(0)
}

/// Reads a folder in each way. The report, the table, the view and the first figure are there in any case.
#[track_caller]
fn read_in_all_ways(here: &Path, folder: &str, policy: &str) {
    for line in [
        format!("report {folder}"),
        format!("export {folder} --to {folder}.csv --force"),
        format!("view {folder} --policy {policy} --no-open --out {folder}.html"),
        format!("export {folder} --figure rescuees-over-time --to {folder}-over-time.svg --force"),
    ] {
        assert!(comes_to_an_end(here, &line), "{line}");
    }
    for line in [format!("compare {folder}"), format!("compare {folder} --json")] {
        comes_to_an_end(here, &line);
    }
    for name in ["groups", "levels", "costs", "differences", "trust", "sorting", "rescuees"] {
        comes_to_an_end(here, &format!("export {folder} --figure {name} --to {folder}-{name}.svg --force"));
    }
}

#[test]
fn small_results_are_read_in_all_ways() {
    let folder = place();
    let here = folder.path();
    let paper = read(&here.join("short.ron"));
    let small = "(name: \"small\", duration_s: 40.0, dt_s: 0.02, arena_m: (20.0, 20.0), \
        roles: [(name: \"carrier\", capacity: 2, resources: 1)], \
        team: [(role: \"carrier\", count: COUNT, center: (10.0, 3.0), width_m: 4.0)], \
        tasks: [(name: \"only\", difficulty: 1, center: (10.0, 14.0), size_m: (2.0, 2.0), grid: (2, 2), \
        rest: (4.0, 4.0))])";
    std::fs::write(here.join("alone.ron"), small.replace("COUNT", "1")).unwrap();
    std::fs::write(here.join("two.ron"), small.replace("COUNT", "2")).unwrap();
    std::fs::write(here.join("long.ron"), paper.replace("duration_s: 30.0", "duration_s: 400.0")).unwrap();
    for (out, sweep) in [
        ("one", "short.ron --policies RNE,DIS --trials 1"),
        ("single", "long.ron --policies RNE --trials 2"),
        ("alone", "alone.ron --policies RNE,DIS --trials 2"),
        ("task", "two.ron --policies RNE,DIS --trials 2"),
        ("instant", "short.ron --policies RNE,DIS --trials 2 --set duration_s=1"),
    ] {
        succeeds(&usar(here, format!("sweep {sweep} --quiet --out {out}").as_str()));
        read_in_all_ways(here, out, "RNE");
    }
}

#[test]
fn an_interrupted_sweep_is_read_in_all_ways() {
    let folder = place();
    let here = folder.path();
    let sweep =
        "sweep short.ron --policies RNE,DIS,ENG,HP_DIS --trials 4000 --jobs 1 --set duration_s=300 --out I";
    let mut child = usar_in(here).args(sweep.split(' ')).stderr(Stdio::null()).spawn().unwrap();
    let journal = here.join("I/journal.jsonl");
    while !journal.exists() || read(&journal).lines().count() < 3 {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    comes_to_an_end(here, "compare I"); // readers may look while it runs
    child.kill().unwrap();
    child.wait().unwrap();
    read_in_all_ways(here, "I", "RNE");
}

#[test]
fn a_policy_without_a_finished_trial_is_reported_as_such() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, "new policy fails --lang python"));
    let program = here.join("fails.py");
    let body = "    tasks = question[\"tasks\"]\n";
    let text =
        read(&program).replace(body, &format!("    if question['round'] > 1: raise SystemExit(3)\n{body}"));
    std::fs::write(&program, text).unwrap();
    let policies = "RNE,fails=EXEC(command: [\"python3\", \"fails.py\"])";
    let sweep = [
        "sweep",
        "short.ron",
        "--policies",
        policies,
        "--trials",
        "2",
        "--set",
        "duration_s=400",
        "--out",
        "F",
    ];
    assert_eq!(usar(here, &sweep).status.code(), Some(1));
    read_in_all_ways(here, "F", "RNE");
    let table = read(&here.join("F/trials.csv"));
    assert_eq!(table.matches(",failed,").count(), 2, "{table}");
    let page = read(&here.join("F/report.html"));
    assert!(page.contains("fails"), "{page}");
}

#[test]
fn one_policy_over_many_cases_is_not_called_unfinished() {
    let folder = place();
    let here = folder.path();
    let sweep = "sweep grid.ron --policies DIS --trials 2 --quiet --out G";
    succeeds(&usar(here, sweep));
    succeeds(&usar(here, "report G"));
    let page = read(&here.join("G/report.html"));
    assert!(page.contains("there is nothing to compare") && !page.contains("no trial has given"), "{page}");
}
