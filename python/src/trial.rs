//! Single trials and single questions.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use experiments::experiment::PolicySpec;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pythonize::{depythonize, pythonize};
use rne_core::{Deadline, PolicyError, Question, Session, TrialStart};
use usar_sim::record::{Status, TrialRecord};
use usar_sim::simulation::Simulation as Trial;

use crate::errors::{raised, unanswered};
use crate::policy::{Given, Policies, given};
use crate::scenario::Scenario;
use crate::waiting::wait_for;

/// Run one trial to its end.
///
/// >>> import usar
/// >>> paper = usar.Scenario.builtin("paper").set(duration_s=120)
/// >>> usar.run(paper, "ENG", seed=7)
/// <usar.Record of ENG, seed 7: 40 rescued, completed>
#[pyfunction]
#[pyo3(signature = (scenario, policy=None, seed=1), text_signature = "(scenario, policy='RNE', seed=1)")]
pub fn run<'py>(
    scenario: &Bound<'py, Scenario>,
    policy: Option<Bound<'py, PyAny>>,
    seed: u64,
) -> PyResult<Bound<'py, PyAny>> {
    let trial = Trial::new(&scenario.get().it, seed);
    let trial = trial.map_err(|error| PyValueError::new_err(error.to_string()))?;
    to_its_end(scenario.py(), trial, policy)
}

/// Runs a trial from where it is to its end.
pub fn to_its_end<'py>(
    py: Python<'py>,
    mut trial: Trial,
    policy: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let stop = Arc::new(AtomicBool::new(false));
    let policies = Policies::of(vec![given_or_rne(policy)?], &stop)?;
    let spec = policies.spec()?;
    spec.check_allowed(trial.given()).map_err(raised)?;
    let mut session = session_of(py, &spec, &trial)?;
    let trial_name = trial.given().name.clone();
    let run = || {
        while trial.step_within(&mut *session, Deadline::when(&stop)).is_none() {
            if stop.load(std::sync::atomic::Ordering::Relaxed) {
                break;
            }
        }
        trial.finish()
    };
    let record = wait_for(py, &stop, |_| Ok(()), run)?;
    policies.raised.check(py)?;
    recorded(py, &record, &trial_name, &spec.label)
}

/// The policy of a call; without one, RNE.
fn given_or_rne(policy: Option<Bound<'_, PyAny>>) -> PyResult<Given> {
    policy.map_or_else(|| Ok(Given::Written("RNE".to_owned())), |policy| given(&policy))
}

/// A session of a policy for a trial.
fn session_of(py: Python<'_>, spec: &PolicySpec, trial: &Trial) -> PyResult<Box<dyn Session>> {
    let start = TrialStart { scenario: &trial.scenario().name, seed: trial.seed() };
    let opened = spec.made().open().and_then(|mut session| session.reset(&start).map(|()| session));
    opened.map_err(|error| failed(py, spec, Some(trial.seed()), None, &error))
}

fn failed(
    py: Python<'_>,
    spec: &PolicySpec,
    seed: Option<u64>,
    round: Option<u64>,
    error: &PolicyError,
) -> PyErr {
    unanswered(py, format!("policy {}: {error}", spec.label), [seed, round], &spec.label)
}

/// A `usar.Record`. A trial that failed has none.
pub fn recorded<'py>(
    py: Python<'py>,
    record: &TrialRecord,
    scenario: &str,
    policy: &str,
) -> PyResult<Bound<'py, PyAny>> {
    if let Status::Failed(reason) = &record.status {
        let message = format!("trial of {policy} with seed {} failed: {reason}", record.seed);
        return Err(match reason.strip_prefix("the policy failed: ") {
            Some(_) => unanswered(py, message, [Some(record.seed), None], policy),
            None => PyRuntimeError::new_err(message),
        });
    }
    let fields = pythonize(py, &record.named(scenario, policy))?;
    py.import("usar._records")?.getattr("Record")?.call1((fields,))
}

/// Answer a question by a policy: the ids of each task's group, or a dict with `groups` and `idle` where robots
/// stay at home.
///
/// >>> import usar
/// >>> trial = usar.Simulation(usar.Scenario.builtin("paper"), seed=1)
/// >>> usar.group(trial.until_asked(), "ENG")
/// [[0, 2, 4, 6, 7, 11], [1, 3, 5, 8, 9, 10]]
#[pyfunction]
#[pyo3(signature = (question, policy=None), text_signature = "(question, policy='RNE')")]
pub fn group(question: &Bound<'_, PyAny>, policy: Option<Bound<'_, PyAny>>) -> PyResult<Py<PyAny>> {
    let py = question.py();
    let question: Question = depythonize(question)?;
    let question = question.checked().map_err(|error| PyValueError::new_err(error.to_string()))?;
    let stop = Arc::new(AtomicBool::new(false));
    let policies = Policies::of(vec![given_or_rne(policy)?], &stop)?;
    let spec = policies.spec()?;
    let decision = py.detach(|| spec.made().decide(&question));
    policies.raised.check(py)?;
    let round = Some(question.round.into());
    let decision = decision.map_err(|error| failed(py, &spec, None, round, &error))?;
    let answer = decision.assignment;
    let answer =
        if answer.idle.is_empty() { pythonize(py, &answer.groups)? } else { pythonize(py, &answer)? };
    Ok(answer.unbind())
}
