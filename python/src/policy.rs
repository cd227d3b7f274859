//! Policies written in Python.

use std::ffi::OsString;
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use experiments::experiment::{PolicySpec, with_oracle};
use programs::{Consent, Launch, Unknown};
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;
use pythonize::{depythonize, pythonize};
use scenario::seed::trial_number;
use teaming::session::each_alone;
use teaming::{
    Act, Asked, Assignment, Basis, Decision, Driver, PolicyError, PolicyKind, Question, Registry, Session,
    TrialStart, Turn,
};

use crate::answer::{asked, groups};
use crate::errors::{raised, unanswered};
use crate::waiting::{Call, Caller};

/// A policy as Python hands it over: as on the command line, or an object of `usar._policies.Own`.
#[derive(FromPyObject)]
pub enum Given {
    /// As on the command line.
    Written(String),
    /// One in Python.
    Own {
        /// Its name in tables.
        name: String,
        /// Called with a question, returns groups.
        decide: Py<PyAny>,
        /// Called with the turns of robots that decide, returns what they do.
        act: Option<Py<PyAny>>,
        /// A text that changes with its answers.
        fingerprint: String,
        /// Whether the same question always gets the same answer.
        deterministic: bool,
    },
}

/// A policy that stands in a call.
pub fn given(policy: &Bound<'_, PyAny>) -> PyResult<Given> {
    policy.py().import("usar._policies")?.call_method1("given", (policy,))?.extract()
}

/// Starts this module as a guard, by its file.
const GUARD: &str = "import importlib.machinery, importlib.util, sys
loader = importlib.machinery.ExtensionFileLoader('_usar', sys.argv[1])
module = importlib.util.module_from_spec(importlib.util.spec_from_loader('_usar', loader))
loader.exec_module(module)
sys.exit(module.guard(sys.argv[2:]))";

/// The words that start this module as a guard of a program; none where Python does not know its own file.
pub fn guard_words(py: Python<'_>) -> Vec<OsString> {
    let of = |module: &str, name: &str| py.import(module)?.getattr(name)?.extract::<OsString>();
    match (of("sys", "executable"), of("usar._usar", "__file__")) {
        (Ok(python), Ok(own)) if !python.is_empty() => {
            let options = ["-I", "-S", "-c", GUARD].map(OsString::from);
            std::iter::once(python).chain(options).chain([own]).collect()
        }
        _ => Vec::new(),
    }
}

/// Shows a line on stderr, where there is one.
fn tell(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// The first exception that a policy has raised in a run.
#[derive(Clone, Default)]
pub struct Raised(Arc<Mutex<Option<Raise>>>);

struct Raise {
    error: PyErr,
    policy: String,
    trial: Option<u64>,
    round: u32,
}

impl Raised {
    /// Raises it as the cause of a `PolicyError`, in the trial of one of these seeds; goes on if there is
    /// none.
    pub fn check(&self, py: Python<'_>, seeds: impl IntoIterator<Item = u64>) -> PyResult<()> {
        let taken = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        let Some(Raise { error, policy, trial, round }) = taken else { return Ok(()) };
        if error.is_instance_of::<PyKeyboardInterrupt>(py) {
            return Err(error);
        }
        let seed = seeds.into_iter().find(|seed| Some(trial_number(*seed)) == trial);
        let trial = seed.map(|seed| format!(", seed {seed}")).unwrap_or_default();
        let message = format!("policy {policy}{trial}, round {round}: {error}");
        let raised = unanswered(py, message, [seed, Some(round.into())], &policy);
        raised.set_cause(py, Some(error));
        Err(raised)
    }
}

/// The policies of a call: the built-in ones, programs, and those in Python.
pub struct Policies {
    /// With the policies in Python.
    pub registry: Registry,
    /// As on the command line.
    pub written: Vec<String>,
    /// What those in Python raise.
    pub raised: Raised,
}

impl Policies {
    /// Takes the policies of a call. An exception of one of them ends its work. Programs may be started whose
    /// commands stand in the call, and others with `allow_programs`.
    pub fn of(py: Python<'_>, given: Vec<Given>, call: &Call, allow_programs: bool) -> PyResult<Self> {
        let mut registry = with_oracle(policies::standard());
        let taken = |error: teaming::RegistryError| PyValueError::new_err(error.to_string());
        let typed = given.iter().filter_map(|policy| match policy {
            Given::Written(text) => Some(text.as_str()),
            Given::Own { .. } => None,
        });
        let refused = Unknown::Refuse("allow_programs=True allows it");
        let unknown = if allow_programs { Unknown::Allow } else { refused };
        let consent = Consent::new(typed, unknown, tell, &call.stop);
        let (stop, guard) = (Arc::clone(&call.stop), guard_words(py));
        let launch = Launch { stop, begin: || (), longest: None, consent, guard };
        programs::add_to(&mut registry, launch).map_err(taken)?;
        let raised = Raised::default();
        let mut written = Vec::new();
        for policy in given {
            match policy {
                Given::Written(text) => written.push(text),
                Given::Own { name, decide, act, fingerprint, deterministic } => {
                    let own = Own {
                        name: name.clone(),
                        decide: Arc::new(decide),
                        act: act.map(Arc::new),
                        fingerprint,
                        is_deterministic: deterministic,
                        raised: raised.clone(),
                        stop: Arc::clone(&call.stop),
                        caller: call.caller.clone(),
                    };
                    let talks = own.act.is_some();
                    let driver: Arc<dyn Driver> = Arc::new(Handle(Arc::new(own)));
                    let kind = PolicyKind::without_options(&name, "a policy in Python", driver);
                    registry.add(kind.clone()).map_err(taken)?;
                    if talks {
                        registry.add_protocol(kind).map_err(taken)?;
                    }
                    written.push(if talks { format!("{name}={name} by {name}") } else { name });
                }
            }
        }
        Ok(Self { registry, written, raised })
    }

    /// The only policy.
    pub fn spec(&self, py: Python<'_>) -> PyResult<PolicySpec> {
        let text = self.written.first().map_or("", String::as_str);
        PolicySpec::parse(text, &self.registry).map_err(|failure| raised(py, failure))
    }
}

/// A policy in Python.
struct Own {
    name: String,
    decide: Arc<Py<PyAny>>,
    act: Option<Arc<Py<PyAny>>>,
    fingerprint: String,
    is_deterministic: bool,
    raised: Raised,
    stop: Arc<AtomicBool>,
    caller: Caller,
}

impl Own {
    /// What it answers; `None` once the call is ending.
    fn ask(&self, question: &Question) -> Option<PyResult<Assignment>> {
        let (decide, question) = (Arc::clone(&self.decide), question.clone());
        self.caller.ask(move |py| {
            let answer = decide.bind(py).call1((asked(py, &question.sealed())?,))?;
            let assignment = groups(&answer)?;
            let checked = assignment.check(&question);
            checked.map_err(|error| PyValueError::new_err(error.to_string())).map(|()| assignment)
        })
    }
}

impl Own {
    /// What robots do in their turns, by this function; `None` once the call is ending.
    fn ask_acts(&self, act: &Arc<Py<PyAny>>, turns: &[Turn]) -> Option<PyResult<Vec<Act>>> {
        let (act, count) = (Arc::clone(act), turns.len());
        let turns: Vec<Turn> = turns.iter().map(Turn::sealed).collect();
        self.caller.ask(move |py| {
            let acts: Vec<Act> = depythonize(&act.bind(py).call1((pythonize(py, &turns)?,))?)?;
            if acts.len() != count {
                let rule = format!("act must return one entry for each of the {count} turns");
                return Err(PyValueError::new_err(format!("{rule}, found {}", acts.len())));
            }
            Ok(acts)
        })
    }
}

struct Handle(Arc<Own>);

impl Driver for Handle {
    fn open(&self) -> Result<Box<dyn Session>, PolicyError> {
        Ok(Box::new(OwnSession { policy: Arc::clone(&self.0), trial: None }))
    }

    fn basis(&self) -> Basis {
        if self.0.is_deterministic { Basis::Question } else { Basis::Undetermined }
    }

    fn fingerprint(&self) -> Option<String> {
        Some(self.0.fingerprint.clone())
    }
}

struct OwnSession {
    policy: Arc<Own>,
    trial: Option<u64>,
}

impl Session for OwnSession {
    fn reset(&mut self, start: &TrialStart<'_>) -> Result<(), PolicyError> {
        self.trial = Some(start.number);
        Ok(())
    }

    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        let answer = self.policy.ask(asked.question).ok_or(PolicyError::Late)?;
        answer.map(Decision::of).map_err(|error| self.raise(error, asked.question.round))
    }

    fn act(&mut self, turns: &[Turn], base: &Asked<'_>) -> Result<Vec<Act>, PolicyError> {
        let Some(act) = &self.policy.act else { return each_alone(self, turns, base) };
        let answer = self.policy.ask_acts(act, turns).ok_or(PolicyError::Late)?;
        answer.map_err(|error| self.raise(error, base.question.round))
    }
}

impl OwnSession {
    /// Notes an exception, which ends the work.
    fn raise(&self, error: PyErr, round: u32) -> PolicyError {
        let Own { name, raised, stop, .. } = &*self.policy;
        let told = PolicyError::Other(error.to_string());
        let raise = Raise { error, policy: name.clone(), trial: self.trial, round };
        raised.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(raise);
        stop.store(true, Ordering::Relaxed);
        told
    }
}
