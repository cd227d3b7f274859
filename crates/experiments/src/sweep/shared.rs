//! Trials that policies share: a policy acts on a mission through its groupings alone, so one that would have grouped every round of a finished trial
//! as it was grouped has that trial for its own, to the bit, and nothing is simulated twice.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use rne_core::{Grouping, GroupingError, GroupingPolicy, Team};
use usar_sim::scenario::Scenario;
use usar_sim::seed::{Purpose, stream};

use super::trial::{Fault, Trial, run_trial};

/// Scenarios and seeds whose trials are kept. Trials are run seed by seed, so that few are needed.
const KEPT: usize = 16;

/// Trials that are kept of each.
const KEPT_OF_SEED: usize = 256;

/// A trial and how each of its rounds was grouped.
struct Decided {
    rounds: Vec<(Team, Grouping)>,
    trial: Trial,
}

impl Decided {
    /// Whether a policy groups every round in the same way.
    fn is_by(&self, policy: &dyn GroupingPolicy, seed: u64) -> bool {
        self.rounds.iter().zip(1..).all(|((team, grouping), round)| {
            let mut draws = stream(seed, Purpose::Grouping, round);
            let groups = policy.group(team, &mut draws);
            groups.is_ok_and(|groups| groups.hard == grouping.hard && groups.easy == grouping.easy)
        })
    }
}

/// The trials of one case and seed.
type OfSeed = Arc<Mutex<Vec<Arc<Decided>>>>;

/// Finished trials of the cases and seeds that were run last.
pub struct SharedTrials {
    is_checked: bool,
    simulated: AtomicUsize,
    latest: Mutex<VecDeque<((usize, u64), OfSeed)>>,
}

impl SharedTrials {
    /// None yet; whether every invariant is checked at every step.
    #[must_use]
    pub fn new(is_checked: bool) -> Self {
        Self { is_checked, simulated: AtomicUsize::new(0), latest: Mutex::default() }
    }

    /// Runs a trial of a case, or finds it among those of other policies.
    ///
    /// # Errors
    /// Those of [`run_trial`].
    pub fn run(
        &self,
        (case, scenario): (usize, &Scenario),
        policy: &dyn GroupingPolicy,
        seed: u64,
        halt: &AtomicBool,
    ) -> Result<Trial, Fault> {
        let of_seed = self.of_seed(case, seed);
        let known = of_seed.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if let Some(decided) = known.iter().find(|decided| decided.is_by(policy, seed)) {
            let mut trial = decided.trial.clone();
            policy.name().clone_into(&mut trial.record.policy);
            return Ok(trial);
        }
        let notes = Notes { policy, rounds: Mutex::default() };
        self.simulated.fetch_add(1, Ordering::Relaxed);
        let trial = run_trial(scenario, &notes, seed, self.is_checked, halt)?;
        let rounds = notes.rounds.into_inner().unwrap_or_else(PoisonError::into_inner);
        let decided = Arc::new(Decided { rounds, trial: trial.clone() });
        let mut known = of_seed.lock().unwrap_or_else(PoisonError::into_inner);
        if known.len() < KEPT_OF_SEED {
            known.push(decided);
        }
        Ok(trial)
    }

    /// How many trials were simulated and not taken over.
    #[must_use]
    pub fn simulated(&self) -> usize {
        self.simulated.load(Ordering::Relaxed)
    }

    /// Lets go of all trials.
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

/// A policy whose decisions are noted.
struct Notes<'p> {
    policy: &'p dyn GroupingPolicy,
    rounds: Mutex<Vec<(Team, Grouping)>>,
}

impl GroupingPolicy for Notes<'_> {
    fn name(&self) -> &'static str {
        self.policy.name()
    }

    fn group(&self, team: &Team, draws: &mut dyn rand::Rng) -> Result<Grouping, GroupingError> {
        let grouping = self.policy.group(team, draws)?;
        let mut rounds = self.rounds.lock().unwrap_or_else(PoisonError::into_inner);
        rounds.push((team.clone(), grouping.clone()));
        Ok(grouping)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use rne_core::{RneOptions, policy_named, policy_names};

    use super::*;
    use crate::experiment::with_settings;

    #[test]
    fn a_shared_trial_is_the_one_that_would_have_been_run() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/paper.ron");
        let (scenario, _) = Scenario::load(&path).unwrap();
        let scenario = with_settings(&scenario, &["duration_s=120".to_owned()]).unwrap();
        let (shared, halt) = (SharedTrials::new(false), AtomicBool::new(false));
        let two = RneOptions { log_base: rne_core::LogBase::Two, ..RneOptions::default() };
        let names = policy_names();
        let mut policies: Vec<_> =
            names.iter().map(|name| policy_named(name, &scenario.rne).unwrap()).collect();
        policies.push(policy_named("RNE", &two).unwrap());
        for seed in 1..4 {
            for policy in &policies {
                let found = shared.run((0, &scenario), &**policy, seed, &halt).unwrap();
                let alone = run_trial(&scenario, &**policy, seed, false, &halt).unwrap();
                assert_eq!(found, alone, "{} seed {seed}", policy.name());
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
        let dis = policy_named("DIS", &scenario.rne).unwrap();
        let (shared, halt) = (SharedTrials::new(false), AtomicBool::new(false));
        let first = shared.run((0, &scenario), &*dis, 1, &halt).unwrap();
        let second = shared.run((1, &short), &*dis, 1, &halt).unwrap();
        assert!(first.record.time_s > 599.0 && second.record.time_s < 61.0);
    }
}
