//! A policy put to the test: random questions, whose answers must keep every rule.

use std::time::{Duration, Instant};

use programs::questions::{question, with_evidence};
use serde::Serialize;
use teaming::{Asked, Assignment, Basis, PolicyError, Question, Session, TrialStart};

use crate::arguments::parse_policy;
use crate::prelude::*;

/// Random questions.
const QUESTIONS: u64 = 1_000;

/// So many breaches are shown.
const SHOWN: usize = 5;

/// What came of the questions.
#[derive(Debug, Serialize)]
struct Checked {
    policy: String,
    questions: u64,
    breaches: Vec<Breach>,
    /// The questions that a second session answers otherwise.
    differing: Vec<u64>,
    start_s: f64,
    /// Time of a decision: half are faster, and 95 % are.
    median_ms: f64,
    p95_ms: f64,
    longest_ms: f64,
}

/// An answer that breaks a rule, or none.
#[derive(Debug, Serialize)]
struct Breach {
    question_seed: u64,
    message: String,
    question: Question,
}

/// Asks a policy random questions, and tells what is wrong with its answers and how long they take.
pub(super) fn check(text: &str, registry: &Registry) -> Result<Report, Failure> {
    let spec = parse_policy("--policy", text, registry)?;
    if !spec.is_of_question() {
        refuse!(
            "--policy: {} plays in the trial that asks, and answers no question outside of one",
            spec.label
        );
    }
    if spec.protocol().is_some() {
        refuse!(
            "--policy: {}: random questions check a rule; how robots talk shows in a trial in which they \
             decide, as in `usar run --check tunnel --set mission.decides=Robots()`",
            spec.label
        );
    }
    let opened = |error: PolicyError| Failure::input(format!("policy {}: {error}", spec.label));
    let begun = Instant::now();
    let mut session = spec.made().open().map_err(opened)?;
    let start_s = begun.elapsed().as_secs_f64();
    let mut twin = match spec.made().it.basis() {
        Basis::Question => Some(spec.made().open().map_err(opened)?),
        Basis::Trial | Basis::Absent | Basis::Undetermined => None,
    };
    let (mut breaches, mut differing, mut times) = (Vec::new(), Vec::new(), Vec::new());
    for seed in 0..QUESTIONS {
        let question = if seed % 2 == 0 { question(seed) } else { with_evidence(question(seed)) };
        let (answer, took) = timed(&mut *session, seed, &question);
        times.push(took);
        if is_stopped() {
            return Err(Failure::Interrupted(format!("stopped after {seed} questions")));
        }
        match &answer {
            Err(message) => breaches.push(Breach { question_seed: seed, message: message.clone(), question }),
            Ok(answer) => {
                let other = twin.as_mut().map(|twin| timed(&mut **twin, seed, &question).0);
                differing.extend(other.filter(|other| other.as_ref() != Ok(answer)).map(|_| seed));
            }
        }
        if let Some(reason) = spec.made().it.gave_up() {
            let last = breaches.last().map_or("", |breach| breach.message.as_str());
            return Err(Failure::run(format!("policy {}: {reason}: {last}", spec.label)));
        }
    }
    times.sort();
    let part = |share: f64| times[((times.len() - 1) as f64 * share) as usize].as_secs_f64() * 1e3;
    let [median_ms, p95_ms, longest_ms] = [0.5, 0.95, 1.0].map(part);
    let (policy, questions) = (spec.label.clone(), QUESTIONS);
    let checked = Checked { policy, questions, breaches, differing, start_s, median_ms, p95_ms, longest_ms };
    let mut out = told(&checked);
    out.rows("policies", [&checked])?;
    out.print()?;
    verdict(&checked)
}

/// Asks a question in a trial of its own. An answer that breaks a rule is none.
fn timed(
    session: &mut dyn Session,
    seed: u64,
    question: &Question,
) -> (Result<Assignment, String>, Duration) {
    let reset = session.reset(&TrialStart { scenario: "check", number: seed });
    let begun = Instant::now();
    let answer = reset.and_then(|()| session.decide(&Asked::of(question)));
    let took = begun.elapsed();
    let answer = answer.map(|decision| decision.assignment.sorted()).map_err(|error| error.to_string());
    let checked = answer.and_then(|answer| match answer.check(question) {
        Ok(()) => Ok(answer),
        Err(error) => Err(error.to_string()),
    });
    (checked, took)
}

fn told(checked: &Checked) -> Report {
    let Checked { policy, questions, breaches, differing, start_s, median_ms, p95_ms, longest_ms } = checked;
    Report::of([
        format!(
            "{policy}: {questions} random questions; against the rules {}, answered otherwise by a second \
             session {}",
            breaches.len(),
            differing.len()
        ),
        format!(
            "started in {start_s:.2} s; a decision took {median_ms:.3} ms (median), 95 % at most {p95_ms:.3} \
             ms, the longest {longest_ms:.3} ms"
        ),
    ])
}

/// Fails with the first answers that are wrong.
fn verdict(checked: &Checked) -> Result<Report, Failure> {
    let Checked { policy, breaches, differing, .. } = checked;
    let mut sentences: Vec<String> = Vec::new();
    for Breach { question_seed, message, .. } in breaches.iter().take(SHOWN) {
        sentences.push(format!("policy {policy}: question {question_seed}: {message}"));
    }
    if let Some(first) = differing.first() {
        sentences.push(format!(
            "policy {policy}: question {first}: it is no function of its question: two sessions answer it in \
             two ways"
        ));
    }
    if sentences.is_empty() { Ok(Report::default()) } else { Err(Failure::run(sentences.join("\n"))) }
}
