//! Files of strangers start nothing, and nothing of them runs in a spreadsheet or a job script. These tests
//! need `python3`.

use std::path::Path;
use std::process::Stdio;

use crate::place::place;
use crate::support::{program, read, succeeds, usar_in};

/// A policy that notes each start, with the names of its environment.
const MARKER: &str = "
import json, os, sys
print(*sorted(os.environ), file=open('started', 'a'))
for line in sys.stdin:
    message = json.loads(line)
    if message['type'] == 'hello':
        answer = {'type': 'hello', 'protocol': 1, 'schema_version': 3, 'name': 'marker'}
    elif message['type'] == 'question':
        groups = [[] for _ in message['question']['tasks']]
        for role, quota in enumerate(message['question']['quotas']):
            ids = [robot['id'] for robot in message['question']['members'] if robot['role'] == role]
            for task, size in enumerate(quota['members']):
                groups[task] += [ids.pop(0) for _ in range(size)]
        answer = {'type': 'decision', 'id': message['id'], 'decision': {'assignment': {'groups': groups}}}
    else:
        break
    print(json.dumps(answer), flush=True)
";

/// The sweep files, by the policy that comes first.
const SWEEPS: [(&str, &str); 2] = [
    ("short", "ENG"),
    ("first", "x=EXEC(command: [\\\"python3\\\", \\\"marker.py\\\"], env: [\\\"ASKED\\\"])"),
];

/// Writes a stranger's files and, made with consent in another folder, the results of their sweep.
fn strangers(here: &Path) {
    std::fs::write(here.join("marker.py"), MARKER).unwrap();
    std::fs::copy(here.join("short.ron"), here.join("first.ron")).unwrap();
    let [(_, own), (_, program)] = SWEEPS;
    for (name, policies) in [("short", [own, program]), ("first", [program, own])] {
        let policies = policies.map(|policy| format!("\"{policy}\"")).join(", ");
        let text = format!(
            "(name: \"paper\", scenario: \"{name}.ron\", policies: [{policies}], trials: 2, \
             expect: [\"rescuees.total: ENG = x within 500\"])"
        );
        std::fs::write(here.join(format!("{name}.sweep.ron")), text).unwrap();
    }
    let axes = "axes: {\"deceit[0].who\": [Count(0), Count(1)]}, set: \
        {\"deceit\": [(who: Count(1), on: [Energy], lie: Scale(factor: 0.5))]}";
    let text = read(&here.join("short.sweep.ron")).replace("trials: 2", &format!("trials: 2, {axes}"));
    std::fs::write(here.join("lies.sweep.ron"), text).unwrap();
}

/// Runs a command as a user who has allowed nothing, without a terminal. Returns its status, stderr, and how
/// many programs it has started.
fn alone(here: &Path, line: &str, more: &[&str]) -> (i32, String, usize) {
    let started = here.join("started");
    let _ = std::fs::remove_file(&started);
    let mut command = usar_in(here);
    command.args(line.split(' ')).args(more).stdin(Stdio::null());
    command.env("XDG_STATE_HOME", here.join("state")).env("SECRET_TOKEN", "1").env("ASKED", "2");
    let output = command.output().unwrap();
    let count = if started.exists() { read(&started).lines().count() } else { 0 };
    (output.status.code().unwrap(), String::from_utf8_lossy(&output.stderr).into_owned(), count)
}

/// Commands that need no program of the stranger's files.
const NEEDS_NONE: [&str; 24] = [
    "check short.sweep.ron",
    "check short.ron",
    "check first.ron",
    "verify D --without-programs",
    "why short.ron --policy RNE",
    "why first.ron --policy RNE",
    "why D --policy ENG",
    "run short.ron",
    "run first.ron --policy ENG",
    "run D/resolved.ron",
    "oracle short.ron --limit 2",
    "oracle D --policy ENG --policies ENG --limit 2",
    "view short.ron --no-open",
    "view D --policy ENG --no-open",
    "export short.ron --to tables.csv",
    "export D --to -",
    "export D --figure groups --to f.svg",
    "export short.ron --policy ENG --to t.csv",
    "export D --policy ENG --at 3 --to p.svg",
    "cluster merge S --out merged",
    "compare D",
    "report D",
    "scenario resolve short.ron",
    "fork D --policy ENG --round 1 --instead DIS",
];

/// Commands that cannot do without one.
const NEEDS_IT: [&str; 18] = [
    "sweep short.sweep.ron",
    "sweep short.ron",
    "run first.ron",
    "test short.sweep.ron",
    "why D --policy x",
    "why first.ron",
    "oracle D --limit 2",
    "oracle first.ron --limit 2",
    "view D --policy x --no-open",
    "view first.ron --no-open",
    "fork first.ron --round 1 --instead DIS",
    "export D --policy x --to more.csv",
    "export first.ron --to more.csv",
    "report D --trial 1",
    "report D --with-replays",
    "study regret short.sweep.ron",
    "cluster submit short.sweep.ron --shards 1",
    "study deceit lies.sweep.ron",
];

#[test]
fn no_verb_starts_a_strangers_program_unasked() {
    let folder = place();
    let here = folder.path();
    strangers(here);
    let (status, stderr, count) = alone(here, "sweep short.sweep.ron --run-programs --quiet --out D", &[]);
    assert!(status == 0 && count > 0, "{stderr}");
    let names = read(&here.join("started"));
    assert!(names.contains("ASKED") && !names.contains("SECRET_TOKEN"), "{names}");
    let (_, stderr, _) = alone(here, "sweep short.sweep.ron --run-programs --quiet --shard 1/1 --out S", &[]);
    assert!(here.join("S").exists(), "{stderr}");
    // The same user may look at them from now on, and nobody else.
    let (status, stderr, count) = alone(here, "verify D", &[]);
    assert!(status == 0 && count > 0, "{stderr}");
    std::fs::remove_dir_all(here.join("state")).unwrap();
    for line in NEEDS_NONE {
        let (status, stderr, count) = alone(here, line, &[]);
        assert_eq!((status, count), (0, 0), "{line}: {stderr}");
    }
    for line in NEEDS_IT {
        let (status, stderr, count) = alone(here, line, &[]);
        assert_eq!((status, count), (2, 0), "{line}: {stderr}");
        assert!(
            stderr.contains("python3 marker.py") && stderr.contains("--run-programs"),
            "{line}: {stderr}"
        );
    }
    for line in ["verify D", "verify D --sample 2"] {
        let (status, stderr, count) = alone(here, line, &[]);
        assert_eq!((status, count), (1, 0), "{line}: {stderr}");
        assert!(stderr.contains("of 4 trials; 2 are of programs, not run"), "{line}: {stderr}");
    }
    assert!(!here.join("state").exists(), "nothing was allowed");
}

/// The program by itself, so that no program of a study stands beside it; `bench` is the study that is asked
/// for.
#[cfg(unix)]
#[test]
fn a_study_is_started_from_an_absolute_folder_and_of_the_same_sources_only() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for place in ["alone", "bin"] {
        std::fs::create_dir(here.join(place)).unwrap();
    }
    std::fs::copy(program(), here.join("alone/usar")).unwrap();
    for file in ["usar-bench", "bin/usar-bench"] {
        let (script, path) = ("#!/bin/sh\necho \"$@\" >> started\necho others\n", here.join(file));
        std::fs::write(&path, script).unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    }
    let refused = |word: &str, path: &str, says: &str| {
        let mut command = std::process::Command::new(here.join("alone/usar"));
        let output = command.args([word, "--generate", "1"]).current_dir(here).env("PATH", path).output();
        let output = output.unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && stderr.contains(says), "{word} {path:?}: {stderr}");
    };
    let install = "bench is a program of its own: cargo install --locked --path studies/bench";
    for path in ["", ":", ".", "bin", "bin:.:./bin:"] {
        refused("bench", path, install);
        refused("benhc", path, &format!("benhc is no command; did you mean `usar bench`? {install}"));
    }
    assert!(!here.join("started").exists(), "nothing was started");
    refused("bench", here.join("bin").to_str().unwrap(), "was built from other sources than this program");
    assert_eq!(read(&here.join("started")), "self source\n", "it was asked, and not started");
}

#[test]
fn a_typed_command_is_allowed_and_an_edit_asks_again() {
    let folder = place();
    let here = folder.path();
    strangers(here);
    let policies = ["--policies", "mine=EXEC(command: [\"python3\", \"marker.py\"])"];
    let (status, stderr, _) = alone(here, "sweep D.ron --trials 2 --quiet", &policies);
    assert_eq!(status, 2, "{stderr}");
    let (status, stderr, _) = alone(here, "sweep short.ron --trials 2 --quiet --out D", &policies);
    assert_eq!(status, 0, "{stderr}");
    assert_eq!(alone(here, "verify D", &[]).0, 0);
    let marker = here.join("marker.py");
    std::fs::write(&marker, read(&marker) + "# edited\n").unwrap();
    let (status, stderr, count) = alone(here, "verify D", &[]);
    assert_eq!((status, count), (1, 0), "{stderr}");
    assert_eq!(alone(here, "verify D --run-programs", &[]).2, 2, "asked, and told to differ or not");
    // A state folder that takes nothing is a note, and the call goes on.
    std::fs::remove_dir_all(here.join("state")).unwrap();
    std::fs::write(here.join("state"), "").unwrap();
    let (status, stderr, _) = alone(here, "sweep short.ron --trials 1 --out E --quiet", &policies);
    assert!(status == 0 && stderr.contains("allowed for this call only"), "{stderr}");
}

/// Answers at a terminal of its own, with the words of the command behind the answer.
const TERMINAL: &str = "
import os, pty, sys
answer, told = sys.argv[1], b''
process, terminal = pty.fork()
if process == 0:
    os.execv(sys.argv[2], sys.argv[2:])
while b'start it? [y/N]' not in told:
    told += os.read(terminal, 1000)
os.write(terminal, answer.encode())
try:
    while more := os.read(terminal, 1000):
        told += more
except OSError:
    pass
print(told.decode())
sys.exit(os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]))
";

#[test]
fn a_person_at_a_terminal_is_asked_and_the_default_is_no() {
    let folder = place();
    let here = folder.path();
    strangers(here);
    for (answer, expected) in [("\n", 2), ("n\n", 2), ("\u{3}", 130), ("y\n", 0)] {
        let _ = std::fs::remove_file(here.join("started"));
        let mut command = std::process::Command::new("python3");
        command.args(["-c", TERMINAL, answer]).arg(program()).args(["run", "first.ron", "--quiet"]);
        command.current_dir(here).env("XDG_STATE_HOME", here.join("state"));
        let output = command.output().unwrap();
        let told = String::from_utf8_lossy(&output.stdout);
        assert!(told.contains("python3 marker.py (and it asks for ASKED of the environment)"), "{told}");
        assert_eq!(output.status.code(), Some(expected), "{answer:?}: {told}");
        assert_eq!(here.join("started").exists(), expected == 0, "{answer:?}");
    }
    assert_eq!(alone(here, "run first.ron --quiet", &[]).0, 0, "what was answered is kept");
}

#[test]
fn job_scripts_allow_the_programs_that_their_submission_allowed() {
    let folder = place();
    let here = folder.path();
    strangers(here);
    let submit = ["cluster", "submit", "short.sweep.ron", "--shards", "1", "--run-programs", "--out", "t"];
    succeeds(&usar_in(here).args(submit).env("XDG_STATE_HOME", here.join("state")).output().unwrap());
    let script = read(&here.join("t-shards/job.sh"));
    assert!(script.contains("short.sweep.ron --run-programs"), "{script}");
}

#[test]
fn the_name_of_a_file_is_no_typed_command() {
    let folder = place();
    let here = folder.path();
    strangers(here);
    let name = "EXEC(command: [\"python3\", \"marker.py\"], env: [\"ASKED\"]).sweep.ron";
    std::fs::copy(here.join("short.sweep.ron"), here.join(name)).unwrap();
    let (status, stderr, count) = alone(here, "sweep --quiet --out D", &[name]);
    assert_eq!((status, count), (2, 0), "{stderr}");
    let (status, stderr, count) = alone(here, "sweep short.sweep.ron --quiet --out", &[name]);
    assert_eq!((status, count), (2, 0), "{stderr}");
}

#[test]
fn no_line_of_the_allowed_programs_is_written_by_a_command() {
    let folder = place();
    let here = folder.path();
    strangers(here);
    let word = "harmless\\n0123456789abcdef python3 marker.py";
    let policy = format!("x=EXEC(command: [\"python3\", \"marker.py\", \"{word}\"])");
    assert_eq!(alone(here, "run short.ron --quiet --policy", &[&policy]).0, 0);
    let allowed = read(&here.join("state/usar/allowed"));
    assert!(allowed.lines().count() == 1 && allowed.contains("harmless"), "{allowed}");
    let forged = "x=EXEC(command: [\"python3\"], env: [\"A)\\nit starts nothing (B\"])";
    let (status, stderr, _) = alone(here, "run short.ron --quiet --policy", &[forged]);
    assert!(status == 2 && stderr.contains("env: must be names of variables"), "{stderr}");
}

#[test]
fn sources_are_few_and_of_this_folder() {
    let folder = place();
    let here = folder.path();
    strangers(here);
    let run = |sources: &str| {
        let policy = format!("x=EXEC(command: [\"python3\", \"marker.py\"], sources: [\"{sources}\"])");
        alone(here, "run short.ron --quiet", &["--policy", &policy])
    };
    for outside in ["/**", "../*", "a/../../*"] {
        let (status, stderr, count) = run(outside);
        assert_eq!((status, count), (2, 0), "{outside}: {stderr}");
        assert!(stderr.contains("it must be of files in the folder"), "{stderr}");
    }
    std::os::unix::fs::symlink("/usr", here.join("link")).unwrap();
    assert!(run("link/**/*.h").1.contains("no file matches"), "links are not followed");
    std::fs::create_dir(here.join("many")).unwrap();
    (0..1001).for_each(|i| std::fs::write(here.join(format!("many/{i}")), "").unwrap());
    let (status, stderr, count) = run("many/*");
    assert_eq!((status, count), (2, 0), "{stderr}");
    assert!(stderr.contains("takes more than 1000 files"), "{stderr}");
    assert_eq!(run("*.py").0, 0);
}

#[test]
fn the_files_of_allowed_programs_say_what_they_allow() {
    let folder = place();
    let here = folder.path();
    strangers(here);
    assert_eq!(alone(here, "run first.ron --run-programs --quiet", &[]).0, 0);
    let text = read(&here.join("state/usar/allowed"));
    assert!(text.contains(" python3 marker.py (and it asks for ASKED of the environment)"), "{text}");
    succeeds(&usar_in(here).args(["check", "first.ron"]).output().unwrap());
}

#[test]
fn no_name_is_a_formula_to_a_spreadsheet() {
    let folder = place();
    let here = folder.path();
    std::fs::write(here.join("ids.csv"), "id,battery,speed\n=1+1,80,1\n@sum,5,2\n-3,7,3\n").unwrap();
    let matrix = succeeds(&usar_in(here).args(["trust", "ids.csv", "--format", "csv"]).output().unwrap());
    let cells: Vec<&str> = matrix.lines().flat_map(|line| line.split(',')).collect();
    assert!(cells.contains(&"'=1+1") && cells.contains(&"'@sum") && cells.contains(&"-3"), "{matrix}");
}

#[test]
fn a_percent_sign_in_a_folder_is_no_word_of_slurms() {
    let folder = place();
    let here = folder.path().join("pct%j");
    std::fs::create_dir(&here).unwrap();
    std::fs::copy(folder.path().join("short.ron"), here.join("short.ron")).unwrap();
    let submit = ["cluster", "submit", "short.ron", "--policies", "DIS", "--trials", "2", "--shards", "2"];
    let line = succeeds(&usar_in(&here).args(submit).output().unwrap());
    let script = read(&here.join("results/paper-shards/job.sh"));
    let log = script.lines().find(|line| line.contains("#SBATCH --output=")).unwrap();
    assert!(log.contains("pct%%j/") && line.contains("pct%%j/results/paper-shards/logs/merge.log"), "{line}");
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "needs --features full")]
fn a_film_has_no_more_pictures_than_frames() {
    let folder = place();
    let here = folder.path();
    let (status, stderr, _) = alone(here, "export short.ron --policy DIS --every 0.001 --to x.gif", &[]);
    assert_eq!(status, 2, "{stderr}");
    assert!(stderr.contains("--every: must be at least ") && stderr.contains("found 0.001"), "{stderr}");
    assert!(!here.join("x.gif").exists());
}

#[test]
fn a_hello_takes_no_longer_than_a_trial_may() {
    let folder = place();
    let here = folder.path();
    std::fs::write(here.join("mute.py"), "import time; time.sleep(600)").unwrap();
    let mute = "m=EXEC(command: [\"python3\", \"mute.py\"], start_s: 86400)";
    let since = std::time::Instant::now();
    let (status, stderr, _) = alone(here, "sweep short.ron --max-trial-s 1", &["--policies", mute]);
    assert_eq!(status, 2, "{stderr}");
    assert!(stderr.contains("it sent no hello within 1 s (--max-trial-s)"), "{stderr}");
    assert!(since.elapsed().as_secs() < 30);
}
