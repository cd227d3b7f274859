//! Programs in folders of their own, and sessions of them.

use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use programs::{Consent, Launch, Unknown};
use teaming::{Asked, Decision, MadePolicy, PolicyError, Question, Registry, Session, TrialStart};

/// What each program of a test can call: it reads a message, sends one, says hello, and knows a right answer.
const PRELUDE: &str = r#"
import json, os, signal, subprocess, sys, time
sys.tracebacklimit = 0
def read():
    return json.loads(sys.stdin.readline())
def send(message):
    print(json.dumps(message), flush=True)
def hello(**more):
    message = read()
    send({"type": "hello", "protocol": 1, "schema_version": 3, "name": "test", "version": "1"} | more)
    return message
def decide(question):
    groups = [[] for _ in question["tasks"]]
    for role, quota in enumerate(question["quotas"]):
        ids = [robot["id"] for robot in question["members"] if robot["role"] == role]
        for task, size in enumerate(quota["members"]):
            groups[task] += ids[:size]
            ids = ids[size:]
    return groups
def answer(groups=None, **more):
    asked = read()
    groups = decide(asked["question"]) if groups is None else groups
    send({"type": "decision", "id": asked["id"], "decision": {"assignment": {"groups": groups} | more}})
"#;

/// The built-in policies and programs, which end when this is set. Any program may be started, and none is
/// remembered.
pub fn registry_until(stop: &Arc<AtomicBool>) -> Registry {
    let consent = Consent::new([], Unknown::Allow, |_| {}, stop).forgetting();
    let launch = Launch { stop: Arc::clone(stop), begin: || {}, longest: None, consent, guard: Vec::new() };
    let mut registry = policies::standard();
    programs::add_to(&mut registry, launch).unwrap();
    registry
}

/// A policy of a program that is started by these words, with more options.
pub fn exec(command: &[&str], more: &str) -> MadePolicy {
    let text = format!("EXEC(command: {command:?}{more})");
    registry_until(&Arc::default()).parse(&text).unwrap_or_else(|error| panic!("{error}"))
}

/// A program in Python in a folder, with the prelude.
pub fn python(folder: &Path, body: &str, more: &str) -> MadePolicy {
    assert!(is_there("python3", &["--version"]), "these tests need python3, which is not there");
    let path = folder.join("program.py");
    std::fs::write(&path, format!("{PRELUDE}{body}\n")).unwrap();
    exec(&["python3", path.to_str().unwrap()], more)
}

/// Whether a language can be used here.
pub fn is_there(program: &str, arguments: &[&str]) -> bool {
    let quiet = Command::new(program).args(arguments).stdout(Stdio::null()).stderr(Stdio::null()).status();
    quiet.is_ok_and(|status| status.success())
}

/// The trial of a number.
pub fn trial(number: u64) -> TrialStart<'static> {
    TrialStart { scenario: "paper", number }
}

/// Asks a question in the trial of a number.
pub fn ask(session: &mut dyn Session, number: u64, question: &Question) -> Result<Decision, PolicyError> {
    session.reset(&trial(number))?;
    session.decide(&Asked::of(question))
}

/// A question about five robots: of the first role two for the first task and one for the second, of the
/// other role one for each.
pub fn small() -> Question {
    let text = include_str!("../../templates/questions.jsonl").lines().next().unwrap();
    Question::from_json(text).unwrap()
}
