//! Costs per rescuee, compared as ratios of sums if some trial has few rescuees or none.
//!
//! The trials with the smallest denominators dominate the mean of the trials' own ratios, and trials
//! without rescuees are missing from it. The ratio of the sums over all trials has neither defect. A
//! trial's *linearised value* is its contribution to that ratio: R + (cost - R rescuees) / (mean of
//! rescuees), where R is the ratio of both subjects together. The mean of a subject's linearised values is
//! its ratio of sums. Tests and standard deviations of these values are therefore valid for the ratio.

use crate::bootstrap::statistic_interval;

/// If a trial has fewer rescuees than this, ratios of sums are compared. One rescuee more or less would
/// change the trial's own ratio by a fifth.
pub const FEW: f64 = 5.0;

/// Costs and rescuees of two subjects, pair by pair.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct Sums {
    /// Number of each pair's trial, ascending.
    pub trials: Vec<u32>,
    /// Cost and rescuees of the first, then of the second.
    pub pairs: Vec<[f64; 4]>,
}

impl Sums {
    /// Whether ratios of these sums are compared: some trial has few rescuees, and neither subject has none
    /// at all.
    pub fn are_compared(&self) -> bool {
        let is_few = self.pairs.iter().any(|pair| pair[1] < FEW || pair[3] < FEW);
        is_few && self.total(1) > 0.0 && self.total(3) > 0.0
    }

    fn total(&self, part: usize) -> f64 {
        self.pairs.iter().map(|pair| pair[part]).sum()
    }

    /// The linearised values of both subjects.
    pub fn linearised(&self) -> [Vec<f64>; 2] {
        let ratio = (self.total(0) + self.total(2)) / (self.total(1) + self.total(3));
        [0, 2].map(|cost| {
            let mean = self.total(cost + 1) / self.pairs.len() as f64;
            let value = |pair: &[f64; 4]| ratio + (pair[cost] - ratio * pair[cost + 1]) / mean;
            self.pairs.iter().map(value).collect()
        })
    }

    /// The interval of the difference of the two ratios, from resampled pairs.
    pub fn interval(&self, confidence: f64) -> Option<[f64; 2]> {
        statistic_interval(self.pairs.len(), confidence, |rows| difference(&self.pairs, rows))
    }
}

/// The first ratio of sums over these pairs minus the second.
fn difference(pairs: &[[f64; 4]], rows: &[usize]) -> Option<f64> {
    let mut sums = [0.0; 4];
    for row in rows {
        sums.iter_mut().zip(pairs[*row]).for_each(|(sum, value)| *sum += value);
    }
    (sums[1] > 0.0 && sums[3] > 0.0).then(|| sums[0] / sums[1] - sums[2] / sums[3])
}

#[cfg(test)]
mod tests {
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    use super::*;

    /// Costs and rescuees; the rescuees are often 0. A rescuee costs 8 in the first cell and 6 in the
    /// second, beside a fixed cost.
    fn sums(pairs: usize, draws: &mut ChaCha8Rng) -> Sums {
        let mut pair = || {
            let load = draws.random::<f64>();
            let mut policy = |ratio: f64| {
                let count = (6.0 * load * draws.random::<f64>()).floor();
                // A trial's cost grows with its rescuees; a random part of it does not depend on them.
                let spent = ratio * count + 4.0 * (draws.random::<f64>() - 0.5);
                [spent + 4.0, count]
            };
            let [a, b] = [policy(8.0), policy(6.0)];
            [a[0], a[1], b[0], b[1]]
        };
        Sums { trials: Vec::new(), pairs: (0..pairs).map(|_| pair()).collect() }
    }

    #[test]
    fn linearised_values_have_the_ratio_of_sums_as_their_mean() {
        let sums = sums(40, &mut ChaCha8Rng::seed_from_u64(1));
        assert!(sums.pairs.iter().any(|pair| pair[1] < 0.5), "some trial has nobody rescued");
        for (values, cost) in sums.linearised().iter().zip([0, 2]) {
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            assert!((mean - sums.total(cost) / sums.total(cost + 1)).abs() < 1e-9);
        }
    }

    /// `xtask coverage` checks more intervals.
    #[test]
    fn the_interval_of_a_difference_of_ratios_covers_what_it_says() {
        let mut draws = ChaCha8Rng::seed_from_u64(2);
        let all = sums(400_000, &mut draws);
        let rows: Vec<usize> = (0..all.pairs.len()).collect();
        let truth = difference(&all.pairs, &rows).unwrap();
        let is_held = |_: &u32| {
            let [low, high] = sums(40, &mut draws).interval(0.95).unwrap();
            low <= truth && truth <= high
        };
        let held = (0..200).filter(is_held).count();
        assert!((180..=199).contains(&held), "{held} of 200");
    }
}
