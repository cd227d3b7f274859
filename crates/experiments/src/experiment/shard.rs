//! Parts of a sweep that run apart. Each part has whole seeds of cases, and therefore whole pairs.

use super::Experiment;
use crate::run::TrialKey;

/// A place in the sweep: case, policy, trial.
pub type Place = (usize, usize, u32);

/// One of several parts of a sweep that run apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Shard {
    /// Number of this part, from 1.
    pub number: u32,
    /// Number of parts.
    pub of: u32,
}

impl std::str::FromStr for Shard {
    type Err = NoShard;

    fn from_str(text: &str) -> Result<Self, NoShard> {
        let parts = text.split_once('/').map(|(number, of)| (number.trim().parse(), of.trim().parse()));
        match parts {
            Some((Ok(number), Ok(of))) if (1..=of).contains(&number) => Ok(Self { number, of }),
            _ => Err(NoShard { found: text.to_owned() }),
        }
    }
}

/// A text that is no [`Shard`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("must be i/n with i from 1 to n, found {found:?}")]
pub struct NoShard {
    /// The text.
    pub found: String,
}

impl Shard {
    /// Whether a seed of a case is in this part. The seeds are dealt in turn, trial by trial and case by
    /// case. After each lap of lcm(parts, cases) seeds the dealing shifts by one part, so that no part gets
    /// the same cases again and again.
    fn has(self, case: usize, cases: usize, trial: u32) -> bool {
        let (of, cases) = (u64::from(self.of), cases as u64);
        let index = (u64::from(trial) - 1) * cases + case as u64;
        let lap = of / gcd(of, cases) * cases;
        (index + index / lap) % of == u64::from(self.number) - 1
    }
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

impl Experiment {
    /// The places of the trials of a shard, or of all trials, in order: case by case, policy by policy.
    /// Adding trials to a sweep leaves each existing trial in its shard.
    pub fn places(&self, shard: Option<Shard>) -> impl Iterator<Item = Place> + '_ {
        let policies = self.policies.len();
        let of_policy =
            move |case, policy| self.trials_of(case, shard).map(move |trial| (case, policy, trial));
        let of_case = move |case| (0..policies).flat_map(move |policy| of_policy(case, policy));
        (0..self.cases.len()).flat_map(of_case)
    }

    /// The numbers of a case's trials in a shard, or of all its trials. Each trial is run under every
    /// policy.
    pub fn trials_of(&self, case: usize, shard: Option<Shard>) -> impl Iterator<Item = u32> + use<> {
        let cases = self.cases.len();
        let is_ours = move |trial: &u32| shard.is_none_or(|shard| shard.has(case, cases, *trial));
        (1..=self.trials).filter(is_ours)
    }

    /// Number of trials in a shard, or in the whole sweep.
    pub fn count(&self, shard: Option<Shard>) -> usize {
        let seeds = match shard {
            None => self.seeds_of_cases(),
            Some(_) => (0..self.cases.len()).map(|case| self.trials_of(case, shard).count()).sum(),
        };
        seeds * self.policies.len()
    }

    /// Number of seeds of all cases together. With more shards than that, some shard would have no trial.
    pub fn seeds_of_cases(&self) -> usize {
        self.cases.len() * self.trials as usize
    }

    /// The keys of the trials of a shard, or of all trials, in the order of [`Experiment::places`].
    pub fn keys(&self, shard: Option<Shard>) -> impl Iterator<Item = TrialKey> + '_ {
        self.places(shard).map(|place| self.key(place))
    }

    /// Whether the sweep, or a shard of it, has a trial at this place with this seed.
    pub fn has(&self, place: Place, seed: u64, shard: Option<Shard>) -> bool {
        let (case, policy, trial) = place;
        let cases = self.cases.len();
        case < cases
            && policy < self.policies.len()
            && (1..=self.trials).contains(&trial)
            && self.seed(trial) == seed
            && shard.is_none_or(|shard| shard.has(case, cases, trial))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shard_of(of: u32, case: usize, cases: usize, trial: u32) -> u32 {
        let has = |number: &u32| Shard { number: *number, of }.has(case, cases, trial);
        let shards: Vec<u32> = (1..=of).filter(has).collect();
        assert_eq!(shards.len(), 1, "each seed of a case is in one shard");
        shards[0]
    }

    #[test]
    fn seeds_are_dealt_evenly_and_each_shard_has_every_case() {
        for (cases, of) in [(1, 3), (4, 4), (4, 8), (6, 4), (9, 2), (3, 7), (40, 12)] {
            let mut seeds = vec![0; of as usize + 1];
            let mut seen = vec![std::collections::BTreeSet::new(); of as usize + 1];
            for trial in 1..=100 {
                for case in 0..cases {
                    let shard = shard_of(of, case, cases, trial) as usize;
                    seeds[shard] += 1;
                    seen[shard].insert(case);
                }
            }
            let (least, most) = (seeds[1..].iter().min().unwrap(), seeds[1..].iter().max().unwrap());
            assert!(most - least <= 1, "{cases} cases, {of} shards: {seeds:?}");
            assert!(seen[1..].iter().all(|seen| seen.len() == cases), "{cases} cases, {of} shards: {seen:?}");
        }
    }

    #[test]
    fn more_shards_than_trials_share_out_the_cases() {
        let used: std::collections::BTreeSet<u32> =
            (1..=2).flat_map(|trial| (0..50).map(move |case| shard_of(100, case, 50, trial))).collect();
        assert_eq!(used.len(), 100);
    }
}
