//! Single trials and single questions.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use experiments::experiment::PolicySpec;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pythonize::{depythonize, pythonize};
use scenario::seed::trial_number;
use teaming::{Deadline, PolicyError, Question, Session, TrialStart};
use usar_sim::record::{Status, TrialRecord};
use usar_sim::simulation::{InTime, Simulation as Trial};

use crate::errors::{raised, unanswered, unread};
use crate::policy::{Given, Policies, given};
use crate::scenario::Scenario;
use crate::waiting::Call;

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
    let call = Call::new();
    let policies = Policies::of(py, vec![given_or_rne(policy)?], &call, false)?;
    let spec = policies.spec(py)?;
    spec.check_allowed(trial.given()).map_err(|failure| raised(py, failure))?;
    let (name, seed, stop) = (trial.given().name.clone(), trial.seed(), Arc::clone(&call.stop));
    let run = || {
        let mut session = session_of(&spec, &trial)?;
        let mut session = InTime::new(&mut *session, Deadline::when(&stop));
        while trial.step(&mut session).is_none() {
            if stop.load(Ordering::Relaxed) {
                break;
            }
        }
        Ok(trial.finish())
    };
    let ran = call.wait_for(py, |_| Ok(()), run)?;
    policies.raised.check(py, [seed])?;
    let record = ran.map_err(|error| failed(py, &spec, [Some(seed), None], &error))?;
    recorded(py, &record, &name, &spec.label)
}

/// The policy of a call; without one, RNE.
fn given_or_rne(policy: Option<Bound<'_, PyAny>>) -> PyResult<Given> {
    policy.map_or_else(|| Ok(Given::Written("RNE".to_owned())), |policy| given(&policy))
}

/// A session of a policy for a trial.
fn session_of(spec: &PolicySpec, trial: &Trial) -> Result<Box<dyn Session>, PolicyError> {
    let start = TrialStart { scenario: &trial.scenario().name, number: trial_number(trial.seed()) };
    spec.made().open().and_then(|mut session| session.reset(&start).map(|()| session))
}

fn failed(py: Python<'_>, spec: &PolicySpec, trial: [Option<u64>; 2], error: &PolicyError) -> PyErr {
    unanswered(py, format!("policy {}: {error}", spec.label), trial, &spec.label)
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
            Some(_) => {
                let round = record.decisions.len() as u64 + 1;
                unanswered(py, message, [Some(record.seed), Some(round)], policy)
            }
            None => PyRuntimeError::new_err(message),
        });
    }
    let fields = pythonize(py, &record.named(scenario, policy))?;
    py.import("usar._records")?.getattr("Record")?.call1((fields,))
}

/// Answer a question by a policy: the ids of each task's group, or a dict with `groups` and `idle` where
/// robots stay at home.
///
/// >>> import usar
/// >>> trial = usar.Simulation(usar.Scenario.builtin("paper"), seed=1)
/// >>> usar.group(trial.until_asked(), "ENG")
/// [[0, 2, 4, 6, 7, 11], [1, 3, 5, 8, 9, 10]]
#[pyfunction]
#[pyo3(signature = (question, policy=None), text_signature = "(question, policy='RNE')")]
pub fn group(question: &Bound<'_, PyAny>, policy: Option<Bound<'_, PyAny>>) -> PyResult<Py<PyAny>> {
    let py = question.py();
    let question: Question = depythonize(question).map_err(|error| unread(py, error))?;
    let question = question.checked().map_err(|error| PyValueError::new_err(error.to_string()))?;
    let call = Call::new();
    let policies = Policies::of(py, vec![given_or_rne(policy)?], &call, false)?;
    let spec = policies.spec(py)?;
    let decision = call.wait_for(py, |_| Ok(()), || spec.made().decide(&question))?;
    policies.raised.check(py, [])?;
    let round = [None, Some(question.round.into())];
    let decision = decision.map_err(|error| failed(py, &spec, round, &error))?;
    let answer = decision.assignment;
    let answer =
        if answer.idle.is_empty() { pythonize(py, &answer.groups)? } else { pythonize(py, &answer)? };
    Ok(answer.unbind())
}
