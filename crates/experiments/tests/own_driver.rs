//! A driver of one's own: its sessions are opened once for a thread and hear of each trial, its kind looks
//! into the registry that makes it, and what it says of its answers decides whether trials are shared.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

use experiments::experiment::{Experiment, Overrides};
use experiments::provenance::Manifest;
use experiments::run::Sessions;
use scenario::seed::trial_number;
use serde::{Deserialize, Serialize};
use teaming::{
    Asked, Basis, Decision, Driver, MadePolicy, PolicyError, PolicyKind, Registry, Session, TrialStart,
};

/// Options: who answers in truth, whether that is said, and whether it declares to need truth and trial.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(default)]
struct Options {
    of: String,
    is_known: bool,
    declares: bool,
}

/// What happened to the sessions.
#[derive(Default)]
struct Seen {
    opened: AtomicU64,
    trials: Mutex<Vec<u64>>,
    /// For each question, whether the truth and the running trial came with it.
    told: Mutex<Vec<[bool; 2]>>,
}

/// Answers as another policy does.
struct Echo {
    of: MadePolicy,
    basis: Basis,
    declares: bool,
    seen: Arc<Seen>,
}

impl Driver for Echo {
    fn open(&self) -> Result<Box<dyn Session>, PolicyError> {
        self.seen.opened.fetch_add(1, Ordering::Relaxed);
        Ok(Box::new(EchoSession { of: self.of.open()?, seen: Arc::clone(&self.seen) }))
    }

    fn basis(&self) -> Basis {
        self.basis
    }

    fn needs_truth(&self) -> bool {
        self.declares
    }

    fn needs_trial(&self) -> bool {
        self.declares
    }
}

struct EchoSession {
    of: Box<dyn Session>,
    seen: Arc<Seen>,
}

impl Session for EchoSession {
    fn reset(&mut self, trial: &TrialStart<'_>) -> Result<(), PolicyError> {
        self.seen.trials.lock().unwrap().push(trial.number);
        self.of.reset(trial)
    }

    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        self.seen.told.lock().unwrap().push([asked.truth().is_some(), asked.trial().is_some()]);
        self.of.decide(asked)
    }
}

/// The built-in policies and `ECHO`.
fn registry(seen: &Arc<Seen>) -> Registry {
    let seen = Arc::clone(seen);
    let make = move |options: Options, registry: &Registry| {
        let of = registry.parse(&options.of).map_err(|error| format!("of: {error}"))?;
        let basis = if options.is_known { Basis::Question } else { Basis::Undetermined };
        let echo: Arc<dyn Driver> =
            Arc::new(Echo { of, basis, declares: options.declares, seen: Arc::clone(&seen) });
        Ok::<_, String>(echo)
    };
    let mut registry = policies::standard();
    registry.add(PolicyKind::made("ECHO", "answers as another does", make)).unwrap();
    registry
}

fn paper() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap().join("scenarios/paper.ron")
}

fn overrides(echo: &str) -> Overrides {
    let policies = Some(vec!["DIS".to_owned(), echo.to_owned()]);
    let set = vec!["duration_s=60.0".to_owned()];
    Overrides { policies, trials: Some(2), set, ..Overrides::default() }
}

fn experiment(echo: &str, seen: &Arc<Seen>) -> Experiment {
    Experiment::load(&paper(), &overrides(echo), &registry(seen)).unwrap()
}

#[test]
fn a_session_is_kept_over_trials_and_shares_them_only_if_its_answers_follow_from_the_question() {
    for (is_known, simulated) in [(true, 2), (false, 4)] {
        let seen: Arc<Seen> = Arc::default();
        let experiment = experiment(&format!("ECHO(of: \"DIS\", is_known: {is_known})"), &seen);
        let (mut sessions, halt) = (Sessions::default(), AtomicBool::new(false));
        for trial in [1, 2] {
            let [dis, echo] = [0, 1].map(|policy| {
                experiment.run(&experiment.key((0, policy, trial)), &mut sessions, &halt).unwrap().record
            });
            assert_eq!(dis.chain, echo.chain, "it answers as DIS does");
        }
        assert_eq!(experiment.simulated(), simulated, "known {is_known}");
        assert_eq!(seen.opened.load(Ordering::Relaxed), 1);
        assert_eq!(*seen.trials.lock().unwrap(), [1, 2].map(|trial| trial_number(experiment.seed(trial))));
    }
}

#[test]
fn only_a_driver_that_declares_it_is_told_the_truth_and_gets_the_trial() {
    for declares in [false, true] {
        let seen: Arc<Seen> = Arc::default();
        let experiment = experiment(&format!("ECHO(of: \"DIS\", declares: {declares})"), &seen);
        let (mut sessions, halt) = (Sessions::default(), AtomicBool::new(false));
        experiment.run(&experiment.key((0, 1, 1)), &mut sessions, &halt).unwrap();
        let told = seen.told.lock().unwrap();
        assert!(!told.is_empty() && told.iter().all(|told| *told == [declares; 2]), "{told:?}");
        let manifest = Manifest::new(&experiment, None, Vec::new());
        assert_eq!(manifest.policies_that_see_truth.len(), usize::from(declares));
    }
}

/// Behind a driver that does not declare it, the control is not told the truth either.
#[test]
fn nobody_passes_the_truth_on_without_having_it() {
    let asks = |policy: &str| {
        let overrides = Overrides {
            set: vec!["duration_s=60.0".to_owned(), "reports=(every_s: 10)".to_owned()],
            ..overrides(policy)
        };
        let experiment = Experiment::load(&paper(), &overrides, &registry(&Arc::default())).unwrap();
        experiment.run_alone(&experiment.key((0, 1, 1)), &mut Sessions::default(), &AtomicBool::new(false))
    };
    let fault = asks("ECHO(of: \"DIS <- Truth\")").unwrap_err();
    assert!(format!("{fault:?}").contains("here nobody knows them"), "{fault:?}");
    assert!(asks("DIS <- Truth").is_ok());
}

#[test]
fn a_kind_that_finds_nothing_in_its_registry_says_so() {
    let error = registry(&Arc::default()).parse("ECHO(of: \"NOBODY\")").unwrap_err().to_string();
    assert!(
        error.starts_with("policy ECHO: of: unknown policy \"NOBODY\"; known policies: RNE, DIS"),
        "{error}"
    );
}
