//! Values of two subjects in one metric, paired by trial.

use std::collections::BTreeSet;
use std::fmt;

use super::sums::Sums;
use crate::paired::LEAST_PAIRS;
use crate::{Moments, bootstrap, cautious};

/// What pairs can say of a difference. Every command asks here before it judges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// Both are the same in all pairs, to the last bit: there is nothing to test.
    Same,
    /// There are fewer distinct pairs than a verdict takes.
    TooFew {
        /// Distinct pairs.
        distinct: usize,
    },
    /// They can be judged.
    Judged,
}

impl Standing {
    /// The standing of this many distinct pairs.
    pub fn of(distinct: usize, is_same: bool) -> Self {
        if distinct > 0 && is_same {
            Self::Same
        } else if distinct < LEAST_PAIRS {
            Self::TooFew { distinct }
        } else {
            Self::Judged
        }
    }
}

/// Why there is no verdict, or that there may be one.
impl fmt::Display for Standing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Same => f.write_str("the same in all trials"),
            Self::TooFew { distinct } => {
                write!(f, "{distinct} of the {LEAST_PAIRS} distinct pairs of trials that a test takes")
            }
            Self::Judged => f.write_str("judged"),
        }
    }
}

/// Values of two subjects in one metric, pair by pair.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct Pairs {
    /// Values of the first.
    pub a: Vec<f64>,
    /// Values of the second.
    pub b: Vec<f64>,
    /// Pairs that repeat others, to the last state: they are left out.
    pub repeated: usize,
    /// Pairs with at least one failed trial.
    pub failed: usize,
    /// Pairs with at least one trial that has not been run.
    pub missing: usize,
    /// Pairs with at least one trial in which the metric is undefined.
    pub undefined: usize,
    /// The sums, if ratios of sums are compared. The values are then linearised.
    pub sums: Option<Sums>,
}

impl Pairs {
    /// The same pairs, with ratios of sums compared instead of means.
    #[must_use]
    pub fn of_sums(self, sums: Sums) -> Self {
        let [a, b] = sums.linearised();
        Self { a, b, undefined: 0, sums: Some(sums), ..self }
    }

    /// What they can say of a difference.
    pub fn standing(&self) -> Standing {
        Standing::of(self.a.len(), self.a == self.b)
    }

    /// The differences of which a test asks whether both signs are as likely.
    pub fn tested(&self) -> Vec<f64> {
        self.sums.as_ref().map_or_else(|| self.differences(), Sums::exchangeable)
    }

    /// The interval of the mean difference, or of the difference of ratios of sums; `None` where they are
    /// not judged.
    pub fn interval(&self, confidence: f64) -> Option<[f64; 2]> {
        match (&self.sums, self.standing()) {
            (_, Standing::Same | Standing::TooFew { .. }) => None,
            (Some(sums), _) => sums.interval(confidence),
            (None, _) => bootstrap::interval(&self.differences(), confidence),
        }
    }

    /// The same, cautious: for verdicts that must seldom be wrong.
    pub fn cautious(&self, confidence: f64) -> Option<[f64; 2]> {
        cautious::around(&self.differences(), confidence, || self.interval(confidence))
    }

    /// The mean difference, or the difference of ratios of sums.
    pub fn difference(&self) -> Option<f64> {
        Moments::of(&self.differences()).mean
    }

    /// First minus second, pair by pair.
    pub fn differences(&self) -> Vec<f64> {
        self.a.iter().zip(&self.b).map(|(a, b)| a - b).collect()
    }
}

/// Tells trials that repeat others apart from new ones, by the hashes of their last states: where nothing is
/// drawn, seeds do not matter, and one world would count several times.
#[derive(Debug, Default)]
pub struct Repeats(BTreeSet<Vec<(u32, u128)>>);

impl Repeats {
    /// Whether trials of this number are new. A hash of 0 is of a trial without numbers, or of one that has
    /// not been run: it repeats no other.
    pub fn is_new(&mut self, trial: u32, hashes: &[u128]) -> bool {
        let own = if hashes.contains(&0) { trial } else { 0 };
        self.0.insert(hashes.iter().map(|hash| (own, *hash)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_trials_with_both_last_states_of_another_repeat_it() {
        let mut repeats = Repeats::default();
        let trials = [(1, [7, 8]), (2, [7, 8]), (3, [7, 9]), (4, [0, 8]), (5, [0, 8])];
        let new = trials.map(|(trial, hashes)| repeats.is_new(trial, &hashes));
        assert_eq!(new, [true, false, true, true, true]);
    }
}
