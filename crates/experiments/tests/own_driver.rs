//! A driver of one's own: its sessions are opened once for a thread and hear of each trial, its kind looks
//! into the registry that makes it, and what it says of its answers decides whether trials are shared.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

use experiments::experiment::{Experiment, Overrides};
use experiments::run::Sessions;
use serde::{Deserialize, Serialize};
use teaming::{
    Asked, Basis, Decision, Driver, MadePolicy, PolicyError, PolicyKind, Registry, Session, TrialStart,
};

/// Options: who answers in truth, and whether that is said.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(default)]
struct Options {
    of: String,
    is_known: bool,
}

/// What happened to the sessions.
#[derive(Default)]
struct Seen {
    opened: AtomicU64,
    seeds: Mutex<Vec<u64>>,
}

/// Answers as another policy does.
struct Echo {
    of: MadePolicy,
    basis: Basis,
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
}

struct EchoSession {
    of: Box<dyn Session>,
    seen: Arc<Seen>,
}

impl Session for EchoSession {
    fn reset(&mut self, trial: &TrialStart<'_>) -> Result<(), PolicyError> {
        self.seen.seeds.lock().unwrap().push(trial.seed);
        self.of.reset(trial)
    }

    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        self.of.decide(asked)
    }
}

/// The built-in policies and `ECHO`.
fn registry(seen: &Arc<Seen>) -> Registry {
    let seen = Arc::clone(seen);
    let make = move |options: Options, registry: &Registry| {
        let of = registry.parse(&options.of).map_err(|error| format!("of: {error}"))?;
        let basis = if options.is_known { Basis::Question } else { Basis::Undetermined };
        let echo: Arc<dyn Driver> = Arc::new(Echo { of, basis, seen: Arc::clone(&seen) });
        Ok::<_, String>(echo)
    };
    let mut registry = policies::standard();
    registry.add(PolicyKind::made("ECHO", "answers as another does", make)).unwrap();
    registry
}

fn experiment(echo: &str, seen: &Arc<Seen>) -> Experiment {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let overrides = Overrides {
        policies: Some(vec!["DIS".to_owned(), echo.to_owned()]),
        trials: Some(2),
        set: vec!["duration_s=60.0".to_owned()],
        ..Overrides::default()
    };
    Experiment::load(&root.join("scenarios/paper.ron"), &overrides, &registry(seen)).unwrap()
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
        assert_eq!(*seen.seeds.lock().unwrap(), [experiment.seed(1), experiment.seed(2)]);
    }
}

#[test]
fn a_kind_that_finds_nothing_in_its_registry_says_so() {
    let error = registry(&Arc::default()).parse("ECHO(of: \"NOBODY\")").unwrap_err().to_string();
    assert!(
        error.starts_with("policy ECHO: of: unknown policy \"NOBODY\"; known policies: RNE, DIS"),
        "{error}"
    );
}
