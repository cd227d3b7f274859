//! Interrupted sweeps: killed, stopped, extended, and refused if they are different sweeps.

use std::collections::BTreeSet;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

use crate::altered_results::{files, journal};
use crate::place::{column, place, refused, rows};
use crate::support::{program, succeeds, usar, usar_in};

#[test]
fn a_sweep_killed_at_random_moments_ends_with_the_files_of_one_left_alone() {
    let kills = std::env::var("USAR_KILLS").map_or(12, |kills| kills.parse().expect("a whole number"));
    let folder = place();
    let command = |out: &str| {
        let arguments = "sweep short.ron --trials 4 --policies RNE,DIS --quiet --out";
        let mut command = usar_in(folder.path());
        command.args(arguments.split(' ')).arg(out).stdout(Stdio::null()).process_group(0);
        command
    };
    assert!(command("alone").status().unwrap().success());
    let (alone, killed) = (files(&folder.path().join("alone")), folder.path().join("killed"));
    let mut draws = ChaCha8Rng::seed_from_u64(kills);
    let (mut sweeps, mut done, mut finished) = (0, 0, 0);
    while done < kills || finished > 0 || sweeps == 0 {
        let mut child = command("killed").spawn().unwrap();
        if done < kills {
            std::thread::sleep(Duration::from_millis(draws.random_range(0..=250)));
            let group = format!("-{}", child.id());
            Command::new("kill").args(["-9", "--", &group]).stderr(Stdio::null()).status().unwrap();
        }
        let status = child.wait().unwrap();
        let now = finished_trials(&killed);
        assert!(now >= finished, "{finished} trials were finished, {now} are left");
        finished = now;
        if status.success() {
            assert!(files(&killed) == alone, "the files differ");
            std::fs::remove_dir_all(&killed).unwrap();
            (sweeps, finished) = (sweeps + 1, 0);
        } else {
            assert_eq!(status.code(), None, "it was killed");
            done += 1;
        }
    }
}

/// Number of finished trials in a folder's journal; each must occur once.
fn finished_trials(folder: &Path) -> usize {
    let journal = journal(folder);
    let whole = journal.rfind('\n').map_or("", |end| &journal[..end]);
    let ids: Vec<&str> = whole.lines().filter_map(|line| line.split("\"id\":\"").nth(1)?.get(..32)).collect();
    let different = ids.iter().collect::<BTreeSet<_>>().len();
    assert_eq!(different, ids.len(), "a trial was done twice");
    different
}

#[test]
fn the_same_command_goes_on_and_more_trials_only_add() {
    let folder = place();
    let sweep = |more: &[&str]| {
        usar(folder.path(), &[&["sweep", "short.ron", "--policies", "RNE,DIS"], more].concat())
    };
    succeeds(&sweep(&["--trials", "2"]));
    let results = folder.path().join("results/paper");
    // Files that a killed process was writing are not files of the sweep.
    let halves = ["host.json.new", "trials.csv.new"].map(|name| results.join(name));
    halves.iter().for_each(|half| std::fs::write(half, "half").unwrap());
    let again = sweep(&["--trials", "2"]);
    assert!(halves.iter().all(|half| !half.exists()));
    assert!(String::from_utf8_lossy(&again.stderr).contains("4 of 4 trials are there already"));
    let more = sweep(&["--trials", "3"]);
    assert!(String::from_utf8_lossy(&more.stderr).contains("4 of 6 trials are there already"));
    succeeds(&sweep(&["--trials", "3", "--out", "results/whole"]));
    assert!(files(&results) == files(&folder.path().join("results/whole")), "added trials change no byte");
    // The file asks for 10 trials and the folder has 3. No number was given on the command line, so that
    // nothing is refused.
    std::fs::write(folder.path().join("one.ron"), small_default(folder.path())).unwrap();
    let plain = usar(folder.path(), "sweep one.ron --policies RNE,DIS");
    assert!(String::from_utf8_lossy(&plain.stderr).contains("6 of 6 trials are there already"));
}

/// `short.ron` with a single trial by default.
fn small_default(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("short.ron")).unwrap().replace("trials: 10", "trials: 1")
}

#[test]
fn another_sweep_in_the_folder_is_refused_and_each_difference_named() {
    let folder = place();
    let here = folder.path();
    let sweep = ["sweep", "short.ron", "--policies", "RNE,DIS", "--trials", "2"];
    succeeds(&usar(here, &sweep));
    let with = |more: &[&'static str]| [&sweep[..], more].concat();
    refused(
        here,
        2,
        &with(&["--set", "costs.energy.per_step=0.009"]),
        &["results/paper has results of something else", "costs.energy.per_step: 0.0045 there, 0.009 now"],
    );
    refused(here, 2, &with(&["--first-seed", "7"]), &["seeds: from 1 on there, from 7 on now"]);
    refused(here, 2, &with(&["--check"]), &["--check: false there, true now"]);
    refused(
        here,
        2,
        "sweep short.ron --policies RNE,DIS --trials 1",
        &["trials: 2 there, more than the 1 asked for; none are taken away"],
    );
    refused(here, 2, "sweep short.ron --policies ENG --trials 2", &["policies: RNE, DIS there, ENG now"]);
    refused(
        here,
        2,
        "sweep short.ron --set costs.energy=1",
        &["--set: costs.energy must be in round brackets"],
    );
    refused(here, 2, "sweep short.ron --set dt_s=-1", &["--set: dt_s must"]);
    succeeds(&usar(here, "sweep short.ron --policies ENG --trials 1 --fresh"));
    assert_eq!(rows(&here.join("results/paper"), "trials.csv").len(), 1);
}

#[test]
fn an_interrupted_sweep_stops_at_once_and_goes_on() {
    let folder = place();
    let here = folder.path();
    let sweep = ["sweep", "short.ron", "--policies", "RNE", "--trials", "60"];
    let child = Command::new(program()).args(sweep).current_dir(here).stderr(Stdio::piped()).spawn().unwrap();
    while journal(&here.join("results/paper")).lines().count() < 2 {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let since = Instant::now();
    let output = child.wait_with_output().unwrap();
    assert!(since.elapsed() < Duration::from_secs(2));
    assert_eq!(output.status.code(), Some(130));
    assert!(String::from_utf8_lossy(&output.stderr).contains("and the same command goes on"));
    let tidy = usar(here, "export results/paper --to -");
    succeeds(&tidy);
    assert!(String::from_utf8_lossy(&tidy.stderr).contains("the sweep is not complete: "));
    let again = usar(here, &sweep);
    succeeds(&again);
    assert!(usar(here, "export results/paper --to -").stderr.is_empty());
    assert!(String::from_utf8_lossy(&again.stderr).contains("of 60 trials are there already"));
    assert_eq!(rows(&here.join("results/paper"), "trials.csv").len(), 60);
}

#[test]
fn trials_that_give_nothing_are_rows_that_can_be_run_again() {
    let folder = place();
    let here = folder.path();
    let sweep = ["sweep", "short.ron", "--policies", "RNE,DIS", "--trials", "2", "--set", "duration_s=600.0"];
    let late = usar(here, &[&sweep[..], &["--max-trial-s", "0.001"]].concat());
    assert_eq!(late.status.code(), Some(1));
    let said = String::from_utf8_lossy(&late.stdout).into_owned();
    assert!(said.contains("4 trials failed, 0 are missing"), "{said}");
    assert!(String::from_utf8_lossy(&late.stderr).contains("trial 1 of RNE (seed 1) timed out"));
    let late = rows(&here.join("results/paper"), "trials.csv");
    let last = |row: &csv::StringRecord| row.iter().next_back().unwrap().to_owned();
    let [status, rescuees] =
        ["status", "rescuees_total"].map(|name| column(&here.join("results/paper"), name));
    let is_late = |row: &csv::StringRecord| &row[status] == "timed_out" && row[rescuees].is_empty();
    assert!(late.len() == 4 && late.iter().all(is_late));
    assert_eq!(last(&late[3]), "usar run resolved.ron --policy DIS --seed 2");
    // The machine may have caused the timeouts, so that these trials are run again.
    succeeds(&usar(here, &sweep));
    assert!(rows(&here.join("results/paper"), "trials.csv").iter().all(|row| &row[status] == "completed"));
}
