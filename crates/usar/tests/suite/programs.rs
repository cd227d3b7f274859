//! Policies that are programs, run as by a user. These tests need `python3`.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::place::{column, place, refused, rows};
use crate::support::{program, read, succeeds, usar, usar_in};

/// A policy with a program in this folder.
const MINE: &str = "mine=EXEC(command: [\"python3\", \"mine.py\"], timeout_s: 20)";

/// Writes the program to begin with, and puts these lines in front of each decision.
fn write(folder: &Path, lines: &str) {
    if !folder.join("mine.py").exists() {
        succeeds(&usar(folder, "new policy mine --lang python"));
    }
    let path = folder.join("mine.py");
    let body = "    tasks = question[\"tasks\"]\n";
    let indented: String = lines.lines().flat_map(|line| ["    ", line, "\n"]).collect();
    let text = read(&path);
    assert!(text.contains(body));
    std::fs::write(path, text.replace(body, &format!("{indented}{body}"))).unwrap();
}

/// A program that notes its number and that of a child of its own, and from a round on never answers.
fn sleeper(folder: &Path, round: u32) {
    let lines = format!(
        "import os, subprocess, time\n\
         child = subprocess.Popen(['sleep', '600']).pid\n\
         with open('pids', 'a') as pids:\n    print(os.getpid(), child, file=pids)\n\
         if question['round'] >= {round}:\n    open('asleep', 'w').close(); time.sleep(600)"
    );
    write(folder, &lines);
}

#[track_caller]
pub fn nothing_lives(folder: &Path) {
    let pids = read(&folder.join("pids")).split_whitespace().collect::<Vec<_>>().join(",");
    let end = Instant::now() + Duration::from_secs(1);
    loop {
        // One `ps` for all: on a busy machine one for each could take the second.
        let listed = Command::new("ps").args(["-o", "stat=,pid=", "-p", &pids]).output().unwrap().stdout;
        let listed = String::from_utf8(listed).unwrap();
        let living: Vec<&str> = listed.lines().filter(|line| !line.starts_with('Z')).collect();
        if living.is_empty() {
            return;
        }
        assert!(Instant::now() < end, "{living:?} live on");
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn energy_in_python_gives_every_bit_of_the_built_in_policy() {
    let folder = place();
    let here = folder.path();
    write(here, "");
    let sweep = ["sweep", "short.ron", "--trials", "3", "--set", "duration_s=250", "--quiet"];
    for (policy, out) in [("ENG", "results/own"), (MINE, "results/mine")] {
        succeeds(&usar(here, &[&sweep[..], &["--policies", policy, "--out", out]].concat()));
    }
    let [own, mine] = ["results/own", "results/mine"].map(|results| here.join(results));
    for table in ["hashes.csv", "rounds.csv", "groups.csv", "robots.csv", "series.csv"] {
        let [own, mine] = [&own, &mine].map(|folder| read(&folder.join(table)));
        assert!(own.lines().count() > 3 && own == mine.replace("mine,", "ENG,"), "{table}");
    }
    // Their last column is the command that runs the trial again.
    let trials = |folder: &Path| -> Vec<Vec<String>> {
        let fields = |row: &csv::StringRecord| row.iter().map(str::to_owned).collect();
        let mut rows: Vec<Vec<String>> = rows(folder, "trials.csv").iter().map(fields).collect();
        rows.iter_mut().for_each(|row| drop(row.pop()));
        rows
    };
    let named = trials(&mine).into_iter().map(|row| {
        let name = |field: String| if field == "mine" { "ENG".to_owned() } else { field };
        row.into_iter().map(name).collect::<Vec<_>>()
    });
    assert_eq!(trials(&own), named.collect::<Vec<_>>());
    let manifest = read(&mine.join("manifest.json"));
    assert!(manifest.contains("\"mine 0.1; protocol ") && manifest.contains("files [mine.py="), "{manifest}");
    assert!(succeeds(&usar(here, "verify results/mine --quiet")).contains("3 of 3 trials match"));
}

#[test]
fn no_process_is_left_when_the_command_is_killed() {
    let folder = place();
    let here = folder.path();
    sleeper(here, 1);
    for _ in 0..3 {
        let _ = std::fs::remove_file(here.join("asleep"));
        let mut child = usar_in(here)
            .args(["sweep", "short.ron", "--policies", MINE, "--jobs", "2"])
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        while !here.join("asleep").exists() {
            std::thread::sleep(Duration::from_millis(5));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        nothing_lives(here);
    }
}

#[test]
fn no_guard_ends_its_program_early() {
    let folder = place();
    let here = folder.path();
    write(here, "");
    for out in 0..10 {
        let line = format!("sweep short.ron --trials 16 --jobs 8 --quiet --out {out} --policies");
        succeeds(&usar_in(here).args(line.split(' ')).arg(MINE).output().unwrap());
    }
}

#[test]
fn a_program_in_a_session_of_its_own_ends_with_the_command() {
    let folder = place();
    let here = folder.path();
    let lines = "import os, time\n\
        if not os.path.exists('asleep'):\n    os.setsid()\n    \
        print(os.getpid(), file=open('pids', 'w'))\n    open('asleep', 'w').close(); time.sleep(600)";
    write(here, lines);
    for signal in ["KILL", "TERM"] {
        let _ = std::fs::remove_file(here.join("asleep"));
        let arguments = ["run", "short.ron", "--policy", MINE];
        let mut child = usar_in(here).args(arguments).stderr(Stdio::null()).spawn().unwrap();
        while !here.join("asleep").exists() {
            std::thread::sleep(Duration::from_millis(5));
        }
        assert!(
            Command::new("kill")
                .args([format!("-{signal}"), child.id().to_string()])
                .status()
                .unwrap()
                .success()
        );
        child.wait().unwrap();
        nothing_lives(here);
    }
}

#[test]
fn a_guard_that_is_not_alone_in_its_group_starts_and_ends_nothing() {
    let folder = place();
    let line = format!("'{}' self guard $$ touch started; echo \"lives $?\"", program().display());
    let output = Command::new("bash").args(["-c", &line]).current_dir(folder.path()).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stdout), "lives 126\n");
    assert!(!folder.path().join("started").exists());
}

#[test]
fn no_process_is_left_after_ctrl_c() {
    let folder = place();
    let here = folder.path();
    sleeper(here, 2);
    let sweep =
        ["sweep", "short.ron", "--policies", MINE, "--trials", "4", "--set", "duration_s=600", "--jobs", "2"];
    let child = usar_in(here).args(sweep).stderr(Stdio::piped()).spawn().unwrap();
    while !here.join("asleep").exists() {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let since = Instant::now();
    let output = child.wait_with_output().unwrap();
    assert!(since.elapsed() < Duration::from_secs(3), "{:?}", since.elapsed());
    assert_eq!(output.status.code(), Some(130), "{}", String::from_utf8_lossy(&output.stderr));
    nothing_lives(here);
}

#[test]
fn ctrl_c_before_the_first_trial_ends_the_program_too() {
    let folder = place();
    let here = folder.path();
    sleeper(here, 1);
    for arguments in
        [&["sweep", "short.ron", "--policies", MINE][..], &["run", "short.ron", "--policy", MINE]]
    {
        let _ = std::fs::remove_file(here.join("asleep"));
        let command = usar_in(here).args(arguments).stderr(Stdio::piped()).spawn();
        let child = command.unwrap();
        while !here.join("asleep").exists() {
            std::thread::sleep(Duration::from_millis(5));
        }
        assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
        assert_eq!(child.wait_with_output().unwrap().status.code(), Some(130));
        nothing_lives(here);
    }
    assert!(!here.join("results").exists());
}

#[test]
fn no_process_is_left_after_a_time_limit() {
    let folder = place();
    let here = folder.path();
    sleeper(here, 2);
    let sweep = [
        "sweep",
        "short.ron",
        "--policies",
        MINE,
        "--trials",
        "2",
        "--set",
        "duration_s=600",
        "--max-trial-s",
        "3",
    ];
    let late = usar(here, &sweep);
    assert_eq!(late.status.code(), Some(1));
    let status = column(&here.join("results/paper"), "status");
    assert!(rows(&here.join("results/paper"), "trials.csv").iter().all(|row| &row[status] == "timed_out"));
    nothing_lives(here);
}

/// The machine may have been slow: such trials are run again, as those that the sweep timed out.
#[test]
fn a_program_that_takes_longer_than_it_may_times_its_trial_out() {
    let folder = place();
    let here = folder.path();
    write(
        here,
        "import os, time\nif question['round'] > 1 and not os.path.exists('fast'):\n    time.sleep(60)",
    );
    let slow = "mine=EXEC(command: [\"python3\", \"mine.py\"], timeout_s: 0.5)";
    let sweep = ["sweep", "short.ron", "--policies", slow, "--trials", "1", "--set", "duration_s=250"];
    let late = usar(here, &sweep);
    assert_eq!(late.status.code(), Some(1));
    let said = "trial 1 of mine (seed 1) timed out: the policy failed: the policy did not answer in time: \
                round 2: it did not answer within 0.5 s (timeout_s)";
    assert!(String::from_utf8_lossy(&late.stderr).contains(said), "{late:?}");
    std::fs::write(here.join("fast"), "").unwrap();
    succeeds(&usar(here, &sweep));
}

#[test]
fn no_process_is_left_at_the_end() {
    let folder = place();
    let here = folder.path();
    sleeper(here, 100);
    for arguments in [
        &["sweep", "short.ron", "--policies", MINE, "--trials", "2", "--quiet"][..],
        &["run", "short.ron", "--policy", MINE, "--quiet"],
        &["why", "short.ron", "--policy", MINE],
        &["check", "--policy", "mine=EXEC(command: [\"python3\", \"no-child.py\"])"],
    ] {
        if arguments[0] == "check" {
            let without = read(&here.join("mine.py")).replace("subprocess.Popen(['sleep', '600']).pid", "0");
            std::fs::write(here.join("no-child.py"), without).unwrap();
        }
        succeeds(&usar(here, arguments));
        nothing_lives(here);
        std::fs::remove_file(here.join("pids")).unwrap();
    }
}

#[test]
fn a_program_that_dies_three_times_ends_the_sweep() {
    let folder = place();
    let here = folder.path();
    write(
        here,
        "if question['round'] > 1:\n    \
         print('no model for', question['round'], file=sys.stderr); sys.exit(4)",
    );
    let sweep =
        ["sweep", "short.ron", "--policies", MINE, "--trials", "9", "--set", "duration_s=600", "--jobs", "1"];
    let said = "trial 1 of mine (seed 1) failed: the policy failed: round 2: it exited with status 4\nits \
                standard error ends with:\n  no model for 2\n";
    let ends = "error: the sweep ends here: policy mine: its program ended by itself in 3 trials in a row";
    let output = usar(here, &sweep);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert!(stderr.contains(said) && stderr.contains(ends), "{stderr}");
    let journal = read(&here.join("results/paper/journal.jsonl"));
    assert!((4..=5).contains(&journal.lines().count()), "{journal}");
}

#[test]
fn a_command_that_cannot_start_is_bad_input_and_nothing_is_written() {
    let folder = place();
    let here = folder.path();
    let no = "x=EXEC(command: [\"no-such-program\"])";
    let says = ["policy x: its command cannot be started: there is no program \"no-such-program\""];
    refused(here, 2, &["sweep", "short.ron", "--policies", no], &says);
    refused(here, 2, &["run", "short.ron", "--policy", no, "--events", "e.jsonl"], &says);
    refused(here, 2, &["check", "--policy", no], &says);
    assert!(!here.join("results").exists() && !here.join("e.jsonl").exists());
}

#[test]
fn a_program_that_answers_in_two_ways_is_refused_unless_it_says_so() {
    let folder = place();
    let here = folder.path();
    write(here, "import random\nfor robot in question['members']: robot['levels'][0] = random.random()");
    let sweep = [
        "sweep",
        "short.ron",
        "--policies",
        "DIS,again=EXEC(command: [\"python3\", \"mine.py\"])",
        "--trials",
        "2",
    ];
    refused(
        here,
        2,
        &sweep,
        &["policy again: it is no function of its question: asked the first question in two"],
    );
    assert!(!here.join("results").exists());
    refused(here, 1, &["check", "--policy", MINE], &["two sessions answer it in two ways"]);
    let text = read(&here.join("mine.py")).replace("\"deterministic\": True", "\"deterministic\": False");
    std::fs::write(here.join("mine.py"), text).unwrap();
    succeeds(&usar(here, &sweep));
    let verified = usar(here, "verify results/paper");
    assert!(succeeds(&verified).contains("2 of 2 trials (of 4) match"));
    let note = "2 trials of policy again are not run again: its answers may differ";
    assert!(String::from_utf8_lossy(&verified.stderr).contains(note));
}

#[test]
fn verify_names_the_first_round_that_is_answered_otherwise() {
    let folder = place();
    let here = folder.path();
    let random = "for robot in question['members']: robot['levels'][0] = random.random()";
    write(here, &format!("import random\nif question['round'] > 1:\n    {random}"));
    let sweep =
        ["sweep", "short.ron", "--policies", MINE, "--trials", "1", "--set", "duration_s=600", "--quiet"];
    succeeds(&usar(here, &sweep));
    let says = "policy mine is no function of its question: asked the same question of round ";
    refused(here, 1, "verify results/paper --quiet", &[says]);
}

#[test]
fn an_edited_program_runs_its_own_trials_again() {
    let folder = place();
    let here = folder.path();
    write(here, "");
    std::fs::write(here.join("table.csv"), "1\n").unwrap();
    let mine = "mine=EXEC(command: [\"python3\", \"mine.py\"], sources: [\"*.csv\"])";
    let policies = format!("DIS,{mine}");
    let sweep = || {
        let done = usar(here, &["sweep", "short.ron", "--policies", &policies, "--trials", "2"]);
        succeeds(&done);
        String::from_utf8_lossy(&done.stderr).into_owned()
    };
    sweep();
    assert!(sweep().contains("4 of 4 trials are there already"));
    let changed = "policy mine has changed since; its trials are run again: 2";
    for (file, text) in [("table.csv", "2\n".to_owned()), ("mine.py", read(&here.join("mine.py")) + "\n")] {
        std::fs::write(here.join(file), text).unwrap();
        let verified = usar(here, "verify results/paper --run-programs");
        succeeds(&verified);
        let note = "note: policy mine has changed since the sweep";
        assert!(String::from_utf8_lossy(&verified.stderr).contains(note));
        let said = sweep();
        assert!(said.contains(changed) && said.contains("2 of 4 trials are there already"), "{said}");
    }
    let version = read(&here.join("mine.py")).replace("\"version\": \"0.1\"", "\"version\": \"0.2\"");
    std::fs::write(here.join("mine.py"), version).unwrap();
    assert!(sweep().contains(changed));
    assert!(read(&here.join("results/paper/manifest.json")).contains("\"mine 0.2; "));
}

#[test]
fn a_new_policy_runs_at_once_in_every_language_that_is_here() {
    let folder = place();
    let here = folder.path();
    let mut ran = Vec::new();
    let languages =
        [("python", "python3"), ("js", "node"), ("rust", "cargo"), ("r", "Rscript"), ("julia", "julia")];
    for (language, needs) in languages {
        let name = format!("of_{language}");
        let said = succeeds(&usar(here, &["new", "policy", &name, "--lang", language]));
        let [test, check] = ["--test", "usar check"].map(|part| {
            let line =
                said.lines().find(|line| line.contains(part) || line.contains(&part.replace("--", "cargo ")));
            line.unwrap_or_else(|| panic!("{part}: {said}")).trim().to_owned()
        });
        let package = match language {
            "r" => Command::new(needs).args(["-e", "library(jsonlite)"]).output(),
            "julia" => Command::new(needs).args(["-e", "using JSON"]).output(),
            _ => Command::new(needs).arg("--version").output(),
        };
        if !package.is_ok_and(|output| output.status.success()) {
            eprintln!("left out: there is no {needs} with what the program needs");
            continue;
        }
        let mut command = Command::new("sh");
        command.args(["-c", &test]).current_dir(here).env("CARGO_NET_OFFLINE", "true");
        let tested = command.env("CARGO_TARGET_DIR", here.join("target")).output().unwrap();
        assert!(tested.status.success(), "{language}: {}", String::from_utf8_lossy(&tested.stderr));
        if language != "rust" {
            let policy = check.split('\'').nth(1).unwrap();
            let says = succeeds(&usar(here, &["check", "--policy", policy]));
            assert!(says.contains("against the rules 0, answered otherwise by a second session 0"), "{says}");
        }
        ran.push(language);
    }
    assert!(ran.contains(&"python") && ran.contains(&"rust"), "{ran:?}");
    let there = "NAME: of_python.py exists; nothing was overwritten";
    refused(here, 2, "new policy of_python --lang python", &[there]);
    refused(here, 2, "new policy Mine --lang python", &["NAME: must begin with a lower-case letter"]);
}

#[test]
fn answers_against_the_rules_are_counted_and_shown() {
    let folder = place();
    let here = folder.path();
    write(here, "if len(question['members']) > 6:\n    return [[] for _ in question['tasks']]");
    let output = usar(here, &["check", "--policy", MINE, "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let checked: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let breaches = checked["tables"]["policies"][0]["breaches"].as_array().unwrap();
    assert!(breaches.len() > 300 && breaches.len() < 1_000, "{}", breaches.len());
    assert!(breaches[0]["question"]["members"].as_array().unwrap().len() > 6);
    let message = breaches[0]["message"].as_str().unwrap();
    assert!(message.contains("must be in exactly one group, found it in none; its line: {"), "{message}");
    refused(here, 2, "check --policy ORACLE", &["answers no question outside of one"]);
}
