//! No process is left behind, and a dead one is replaced.

use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{sleep, spawn};
use std::time::{Duration, Instant};

use teaming::{Asked, Deadline, PolicyError};

use crate::support::{ask, python, registry_until, small};

/// Starts a child of its own, notes both numbers, and says hello.
const WITH_CHILD: &str = "
child = subprocess.Popen(['sleep', '600'])
with open(os.path.dirname(__file__) + '/pids', 'w') as pids:
    pids.write(f'{os.getpid()} {child.pid}')
hello()
";

/// The processes whose numbers were noted in a folder and that still live.
fn living(folder: &Path) -> Vec<String> {
    let pids = std::fs::read_to_string(folder.join("pids")).unwrap().replace(' ', ",");
    let listed = Command::new("ps").args(["-o", "stat=,pid=", "-p", &pids]).output().unwrap().stdout;
    let listed = String::from_utf8(listed).unwrap();
    listed.lines().filter(|line| !line.starts_with('Z')).map(str::to_owned).collect()
}

#[track_caller]
fn nothing_lives(folder: &Path) {
    let end = Instant::now() + Duration::from_secs(1);
    while !living(folder).is_empty() && Instant::now() < end {
        sleep(Duration::from_millis(10));
    }
    assert_eq!(living(folder), Vec::<String>::new());
}

#[test]
fn a_program_hears_its_bye_and_takes_its_children_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let body =
        format!("{WITH_CHILD}answer()\nopen(os.path.dirname(__file__) + '/bye', 'w').write(read()['type'])");
    let mut session = python(folder.path(), &body, "").open().unwrap();
    ask(&mut *session, 1, &small()).unwrap();
    assert_eq!(living(folder.path()).len(), 2);
    let since = Instant::now();
    drop(session);
    assert!(since.elapsed() < Duration::from_secs(1), "{:?}", since.elapsed());
    assert_eq!(std::fs::read_to_string(folder.path().join("bye")).unwrap(), "bye");
    nothing_lives(folder.path());
}

#[test]
fn a_program_that_does_not_end_is_killed_after_two_seconds() {
    let folder = tempfile::tempdir().unwrap();
    let body = format!("signal.signal(signal.SIGTERM, signal.SIG_IGN)\n{WITH_CHILD}time.sleep(600)");
    let session = python(folder.path(), &body, "").open().unwrap();
    let since = Instant::now();
    drop(session);
    let took = since.elapsed().as_secs_f64();
    assert!((1.9..4.0).contains(&took), "{took}");
    nothing_lives(folder.path());
}

#[test]
fn a_deadline_ends_the_program_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = python(folder.path(), &format!("{WITH_CHILD}time.sleep(600)"), "").open().unwrap();
    let flag = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&flag);
    let clock = spawn(move || {
        sleep(Duration::from_millis(100));
        raised.store(true, Ordering::Relaxed);
    });
    let since = Instant::now();
    let question = small();
    let asked = Asked::of(&question).until(Deadline::when(&flag));
    assert_eq!(session.decide(&asked), Err(PolicyError::Late));
    assert!(since.elapsed() < Duration::from_secs(1), "{:?}", since.elapsed());
    nothing_lives(folder.path());
    clock.join().unwrap();
}

#[test]
fn when_everything_stops_the_program_ends_within_half_a_second() {
    let folder = tempfile::tempdir().unwrap();
    let stop: Arc<AtomicBool> = Arc::default();
    let made = python(folder.path(), &format!("{WITH_CHILD}time.sleep(600)"), "");
    let text = format!("EXEC{}", made.options);
    let session = registry_until(&stop).parse(&text).unwrap().open().unwrap();
    stop.store(true, Ordering::Relaxed);
    let since = Instant::now();
    drop(session);
    assert!(since.elapsed() < Duration::from_millis(500), "{:?}", since.elapsed());
    nothing_lives(folder.path());
}

#[test]
fn a_program_that_does_not_read_is_not_waited_for_longer_than_it_may() {
    let folder = tempfile::tempdir().unwrap();
    let mut question = small();
    question.tasks[0].name = "long".repeat(100_000); // more than a pipe holds
    let body = format!("{WITH_CHILD}time.sleep(600)");
    let mut session = python(folder.path(), &body, ", timeout_s: 0.3").open().unwrap();
    let error = ask(&mut *session, 1, &question).unwrap_err().to_string();
    assert_eq!(
        error,
        "the policy did not answer in time: round 1: it did not answer within 0.3 s (timeout_s)"
    );
    nothing_lives(folder.path());
}

#[test]
fn a_dead_program_is_replaced_for_the_next_trial() {
    let folder = tempfile::tempdir().unwrap();
    let body = "
count = os.path.dirname(__file__) + '/count'
starts = int(open(count).read()) if os.path.exists(count) else 0
open(count, 'w').write(str(starts + 1))
if hello()['process'] == 0: sys.exit(3)
answer()
answer()";
    let policy = python(folder.path(), body, "");
    let mut session = policy.open().unwrap();
    let dead = "round 1: it exited with status 3";
    assert_eq!(ask(&mut *session, 1, &small()).unwrap_err().to_string(), dead);
    assert_eq!(ask(&mut *session, 1, &small()).unwrap_err().to_string(), dead, "the trial has failed");
    assert!(ask(&mut *session, 2, &small()).is_ok() && ask(&mut *session, 3, &small()).is_ok());
    assert_eq!(std::fs::read_to_string(folder.path().join("count")).unwrap(), "2");
    assert_eq!(policy.it.gave_up(), None);
}

#[test]
fn a_program_without_a_hello_is_waited_for_once() {
    let folder = tempfile::tempdir().unwrap();
    let policy = python(folder.path(), "time.sleep(60)", ", start_s: 1");
    let since = Instant::now();
    assert_eq!(policy.fingerprint().unwrap(), "a program that does not start");
    assert_eq!(policy.it.basis(), teaming::Basis::Question);
    assert_eq!(policy.open().err().unwrap().to_string(), "it sent no hello within 1 s (start_s)");
    assert!(since.elapsed() < Duration::from_secs(2), "{:?}", since.elapsed());
}

#[test]
fn a_program_that_becomes_another_one_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let body = "hello(version=str(os.path.exists(os.path.dirname(__file__) + '/new')))\nanswer()";
    let policy = python(folder.path(), body, "");
    let before = policy.fingerprint().unwrap();
    assert!(before.starts_with("test False; protocol "), "{before}");
    drop(policy.open().unwrap());
    std::fs::write(folder.path().join("new"), "").unwrap();
    let error = policy.open().err().unwrap().to_string();
    assert_eq!(error, "its hello changed while it was running: it was test False, and is now test True");
}

#[test]
fn three_deaths_in_a_row_are_enough() {
    let folder = tempfile::tempdir().unwrap();
    let body = "if hello()['process'] == 2: answer()\nsys.exit(0)";
    let policy = python(folder.path(), body, "");
    let mut session = policy.open().unwrap();
    let mut deaths = |seed| {
        let died = ask(&mut *session, seed, &small()).is_err();
        (died, policy.it.gave_up().is_some())
    };
    let expected = [(true, false), (true, false), (false, false), (true, false), (true, false), (true, true)];
    assert_eq!([1, 2, 3, 4, 5, 6].map(&mut deaths), expected);
}
