//! Trials that policies share. A policy acts on a mission only through its assignments. If a policy would
//! form the same groups in every round, it reuses the finished trial instead of simulating it again.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use teaming::{Asked, Basis, Deadline, Session};
use usar_sim::record::DecisionRecord;

use super::sessions::Player;
use super::trial::{Fault, Trial, TrialSetup, run_trial};

/// Number of combinations of case and seed whose trials are kept. Few are needed, because trials are run
/// seed by seed.
const KEPT: usize = 16;

/// Largest number of trials kept for each of them.
const KEPT_OF_SEED: usize = 256;

/// The finished trial as another policy would have run it: only the policy's account of its decisions
/// differs. `None` if the policy would form other groups.
fn as_decided_by(trial: &Trial, session: &mut dyn Session, deadline: Deadline<'_>) -> Option<Trial> {
    let decide = |asked: &DecisionRecord| {
        let question = &trial.record.question(asked);
        let decision = session.decide(&Asked::of(question).knowing(asked.team()).until(deadline)).ok()?;
        let is_same = decision.assignment == asked.decision.assignment;
        is_same.then(|| DecisionRecord { decision, ..asked.clone() })
    };
    let decisions = trial.record.decisions.iter().map(decide).collect::<Option<Vec<_>>>()?;
    let mut trial = trial.clone();
    trial.record.decisions = decisions;
    Some(trial)
}

/// The trials of one case and seed.
type OfSeed = Arc<Mutex<Vec<Arc<Trial>>>>;

/// Finished trials of the latest cases and seeds.
#[derive(Default)]
pub struct SharedTrials {
    simulated: AtomicUsize,
    latest: Mutex<VecDeque<((usize, u64), OfSeed)>>,
}

impl SharedTrials {
    /// Runs a trial of a case, or reuses a trial of another policy.
    ///
    /// # Errors
    /// Those of [`run_trial`].
    pub fn run(
        &self,
        case: usize,
        setup: &TrialSetup,
        player: Player<'_>,
        halt: &AtomicBool,
    ) -> Result<Trial, Fault> {
        let Player { session, basis } = player;
        let of_seed = self.of_seed(case, setup.seed);
        let known = of_seed.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let robots_decide = !setup.scenario.mission.decides.is_base();
        if basis == Basis::Question && !robots_decide {
            let deadline = Deadline::when(halt);
            for trial in known {
                session.reset(&setup.start()).map_err(|error| Fault::of_policy(&error))?;
                if let Some(trial) = as_decided_by(&trial, &mut *session, deadline) {
                    return Ok(trial);
                }
            }
        }
        self.simulated.fetch_add(1, Ordering::Relaxed);
        let trial = run_trial(setup, session, halt)?;
        if basis == Basis::Undetermined || robots_decide {
            return Ok(trial);
        }
        let finished = Arc::new(trial.clone());
        let mut known = of_seed.lock().unwrap_or_else(PoisonError::into_inner);
        if known.len() < KEPT_OF_SEED {
            known.push(finished);
        }
        Ok(trial)
    }

    /// Number of trials that were simulated instead of reused.
    pub fn simulated(&self) -> usize {
        self.simulated.load(Ordering::Relaxed)
    }

    /// Frees all trials.
    pub fn forget(&self) {
        self.latest.lock().unwrap_or_else(PoisonError::into_inner).clear();
    }

    fn of_seed(&self, case: usize, seed: u64) -> OfSeed {
        let mut latest = self.latest.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, known)) = latest.iter().find(|(name, _)| *name == (case, seed)) {
            return Arc::clone(known);
        }
        if latest.len() == KEPT {
            latest.pop_front();
        }
        let new = OfSeed::default();
        latest.push_back(((case, seed), Arc::clone(&new)));
        new
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use scenario::Scenario;

    use super::*;
    use crate::experiment::with_settings;

    fn player(session: &mut dyn Session) -> Player<'_> {
        Player { session, basis: Basis::Question }
    }

    #[test]
    fn a_shared_trial_is_the_one_that_would_have_been_run() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/paper.ron");
        let (scenario, _) = Scenario::load(&path).unwrap();
        let scenario = with_settings(&scenario, &["duration_s=120".to_owned()]).unwrap();
        let (shared, halt) = (SharedTrials::default(), AtomicBool::new(false));
        let registry = policies::standard();
        let names = registry.names();
        let mut policies: Vec<_> = names.iter().map(|name| registry.parse(name).unwrap()).collect();
        policies.push(registry.parse("RNE(log_base: Two)").unwrap());
        for seed in 1..4 {
            let setup = TrialSetup { scenario: &scenario, seed, is_checked: false };
            for policy in &policies {
                let mut session = policy.open().unwrap();
                let found = shared.run(0, &setup, player(&mut *session), &halt).unwrap();
                let alone = run_trial(&setup, &mut *session, &halt).unwrap();
                assert_eq!(found, alone, "{policy:?} seed {seed}");
            }
        }
        assert!(
            shared.simulated() <= 3 * names.len(),
            "the base of the logarithm decides nothing: {} trials",
            shared.simulated()
        );
    }

    #[test]
    fn trials_of_other_cases_are_not_taken() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/paper.ron");
        let (scenario, _) = Scenario::load(&path).unwrap();
        let short = with_settings(&scenario, &["duration_s=60".to_owned()]).unwrap();
        let mut dis = policies::standard().open("DIS").unwrap();
        let (shared, halt) = (SharedTrials::default(), AtomicBool::new(false));
        let mut run = |case, scenario| {
            let setup = TrialSetup { scenario, seed: 1, is_checked: false };
            shared.run(case, &setup, player(&mut *dis), &halt).unwrap()
        };
        let (first, second) = (run(0, &scenario), run(1, &short));
        assert!(first.record.time_s > 599.0 && second.record.time_s < 61.0);
    }
}
