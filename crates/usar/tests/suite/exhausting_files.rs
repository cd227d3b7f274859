//! Files designed to use up all time or memory: one of the limits of docs/limits.md refuses each at once.

use std::fmt::Write;
use std::path::Path;
use std::time::{Duration, Instant};

use crate::place::refused;
use crate::support::{succeeds, usar};

const START: &str = "(name: \"s\", duration_s: 10.0, dt_s: 0.02, arena_m: (1000.0, 1000.0),";
const TEAM: &str = "team: [(role: \"robot\", count: 1, center: (5.0, 5.0), width_m: 0.0)],";
const TASK: &str = "tasks: [(name: \"t\", difficulty: 1, center: (500.0, 500.0), size_m: (1.0, 1.0), grid: \
    (1, 1), rest: (800.0, 800.0))],";

/// This many entries; `#` in an entry is replaced by its number.
fn entries(count: usize, entry: &str) -> String {
    let mut list = String::new();
    for i in 0..count {
        let _ = write!(list, "{},", entry.replace('#', &i.to_string()));
    }
    list
}

/// A scenario with one robot and one task, and additional text.
fn scenario(more: &str) -> String {
    format!("{START}{TEAM}{TASK}{more})")
}

fn sweep(more: &str) -> String {
    format!("(name: \"s\", scenario: \"ok.ron\", {more})")
}

/// Checks that a file is refused with these words, and at once. The time limit allows for a build without
/// optimisation on a busy machine.
#[track_caller]
fn at_once(here: &Path, text: &str, words: &str) {
    std::fs::write(here.join("hostile.ron"), text).unwrap();
    let start = Instant::now();
    refused(here, 2, "check hostile.ron", &[words]);
    let taken = start.elapsed();
    assert!(taken < Duration::from_secs(20), "{words}: refused after {taken:?}");
}

#[test]
fn texts_that_are_too_deep_or_have_too_much_in_them_are_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for bracket in ["[", "(", "{", "Some(", "(a:"] {
        at_once(here, &bracket.repeat(700_000), "hostile.ron:1:");
    }
    at_once(here, &format!("(name: {}", "[".repeat(1_000_000)), "at most 64 brackets within one another");
    at_once(here, &scenario(&format!("debris: [{}]", "(),".repeat(1_300_000))), "at most 200000 values");
    at_once(here, &scenario(&format!("debris: [{}]", "1,".repeat(2_000_000))), "at most 200000 values");
    at_once(
        here,
        &format!("(name: \"{}\")", "a".repeat(4_000_000)),
        "at most 65536 bytes in a string or a name",
    );
    at_once(here, &format!("({}: 1)", "a".repeat(4_000_000)), "at most 65536 bytes in a string or a name");
    at_once(here, &" ".repeat(5 << 20), "larger than the 4 MiB");
}

#[test]
fn tables_with_too_many_entries_are_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let errands = entries(20_000, "(robot: 0, to: [(1, 1)])");
    at_once(here, &format!("{START}{TEAM}errands: [{errands}])"), "errands[1].robot must not stand twice");
    let wrong = entries(1_000, "(at: (-1, 1), radius_m: 1)");
    at_once(here, &scenario(&format!("radiation: [{wrong}]")), "radiation[0].at must lie in the arena");
    let zones = entries(30_000, "(at: (-1, 1), radius_m: 1)");
    at_once(here, &scenario(&format!("radiation: [{zones}]")), "radiation must have at most 1000 entries");
    let roles = entries(90_000, "(name: \"r#\")");
    at_once(here, &scenario(&format!("roles: [{roles}]")), "roles must have 1 to 64 entries, found 90000");
    let quota = entries(150_000, "\"r#\": 1");
    let task = TASK.replace("))]", &format!("), quota: {{{quota}}})]"));
    at_once(here, &format!("{START}{TEAM}{task})"), "tasks.t.quota must have at most 64 entries");
    let wide = START.replace("1000.0, 1000.0", "8000.0, 8000.0");
    let rows = entries(20_000, "(role: \"robot\", count: 1, center: (5.0, 7.#), width_m: 0.0)");
    at_once(here, &format!("{wide}team: [{rows}],{TASK})"), "must leave at least 0.8 m between");
    let pieces = entries(20_000, "(shape: Disc(9.0), at: (5.0, 5.0))");
    at_once(
        here,
        &scenario(&format!("debris: [{pieces}]")),
        "debris[0].at must leave every robot's home free",
    );
}

#[test]
fn sweeps_with_too_many_policies_seeds_values_or_cases_are_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("ok.ron"), scenario("")).unwrap();
    at_once(
        here,
        &sweep(&format!("policies: [{}]", entries(100_000, "\"p#=RNE\""))),
        "policies: must have at most 10000",
    );
    at_once(
        here,
        &sweep(&format!("seeds: [{}]", entries(190_000, "#"))),
        "seeds: must have at most 100000 entries",
    );
    let twice = entries(90_000, "#") + "5";
    at_once(here, &sweep(&format!("seeds: [{twice}]")), "seeds: must differ");
    at_once(
        here,
        &sweep(&format!("axes: {{\"duration_s\": [{}]}}", entries(20_000, "3#.0"))),
        "at most 1000 values",
    );
    let axis = |path: &str| format!("\"{path}\": [{}],", entries(311, "3#.0"));
    let both = axis("mission.rest_s") + &axis("mission.loading_s");
    at_once(here, &sweep(&format!("axes: {{{both}}}")), "axes: must span at most 10000 cases");
    at_once(
        here,
        &sweep(&format!("axes: {{{}}}", entries(50_000, "\"k#\": []"))),
        "axes: must have at most 16 entries",
    );
    at_once(
        here,
        &sweep(&format!("set: {{{}}}", entries(50_000, "\"k#\": 1"))),
        "set: must have at most 1000 entries",
    );
    at_once(here, &sweep("trials: 2000000"), "trials: must be a count from 1 to 1000000");
}

#[test]
fn what_is_no_regular_file_is_not_waited_for() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("ok.ron"), scenario("")).unwrap();
    let status = std::process::Command::new("mkfifo").arg(here.join("pipe")).status();
    assert!(status.unwrap().success());
    std::fs::File::create(here.join("sparse")).unwrap().set_len(1 << 40).unwrap();
    std::fs::File::create(here.join("zeros")).unwrap().set_len(200 << 20).unwrap();
    for (file, words) in [
        ("pipe", "is not a regular file"),
        ("/dev/zero", "is not a regular file"),
        (".", "is a folder"),
        ("sparse", "is larger than the"),
        ("zeros", ""),
    ] {
        for arguments in [
            vec!["check", file],
            vec!["sweep", file],
            vec!["trust", file],
            vec!["run", "ok.ron", "--resume", file],
        ] {
            refused(here, 2, &arguments, &[file, words]);
        }
        if file != "." {
            refused(here, 2, &["run", file], &[file, words]);
            refused(here, 2, &["view", file], &[file, words]);
        }
    }
}

#[test]
fn work_that_takes_long_needs_a_word_and_says_what_it_takes() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let long = scenario("").replace("duration_s: 10.0", "duration_s: 86400.0").replace("0.02", "0.001");
    let pieces = entries(40, "(shape: Disc(0.5), at: (7#.0, 500.0))");
    std::fs::write(here.join("long.ron"), long.replace("tasks:", &format!("debris: [{pieces}], tasks:")))
        .unwrap();
    let words = "41 robots and pieces of debris x 86400000 steps is 3.5e9, more than 1e9: about 39 minutes \
        on one thread. --allow-expensive";
    refused(here, 2, "run long.ron", &[words]);
    refused(here, 2, "sweep long.ron", &[words]);
    refused(here, 2, "view long.ron", &[words]);
    assert!(succeeds(&usar(here, "check long.ron")).contains("ok, but expensive: 41 robots"));
    let allowed = ["run", "long.ron", "--allow-expensive", "--max-trial-s", "0.0001"];
    refused(here, 1, &allowed, &["the trial took longer than 0.0001 s"]);
    std::fs::write(here.join("ok.ron"), scenario("")).unwrap();
    std::fs::write(
        here.join("many.ron"),
        sweep(
            "trials: 1000000, axes: {\"mission.rest_s\": [1, 2], \"duration_s\": [1000, 2000]}, \
             policies: [\"RNE\", \"DIS\", \"ENG\"]",
        ),
    )
    .unwrap();
    refused(here, 2, "sweep many.ron", &["x 12000000 trials is 1.2e12, more than 1e12"]);
}

/// A path that leads out of its folder is named with the line, without the text that stands there.
#[test]
fn text_from_outside_the_folder_is_not_shown() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::create_dir(here.join("inside")).unwrap();
    std::fs::write(here.join("secret"), "password: 'hunter2'").unwrap();
    for text in ["(base: \"../secret\", name: \"a\")", "(scenario: \"../secret\", name: \"a\")"] {
        std::fs::write(here.join("inside/a.ron"), text).unwrap();
        let output = usar(&here.join("inside"), &["check", "a.ron"]);
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains("secret") && told.contains("is not well-formed (line 1"), "{told}");
        assert!(!told.contains("hunter2") && !told.contains("password"), "{told}");
    }
}
