//! Costs per rescuee, compared as ratios of sums if some trial has few rescuees or none.
//!
//! The trials with the smallest denominators dominate the mean of the trials' own ratios, and trials
//! without rescuees are missing from it. The ratio of the sums over all trials has neither defect. A
//! trial's *linearised value* is its contribution to that ratio: R + (cost - R rescuees) / (mean of
//! rescuees), where R is the subject's ratio of sums, which is also their mean. Their standard deviation is
//! therefore valid for the ratio. A test of signs takes what a trial costs beyond the ratio of *both*
//! subjects together: if they do not differ, each pair's difference of that is as likely as its opposite.

use crate::bootstrap::statistic_interval;

/// If a trial has fewer rescuees than this, ratios of sums are compared. One rescuee more or less would
/// change the trial's own ratio by a fifth.
pub const FEW: f64 = 5.0;

/// Costs and rescuees of two subjects, pair by pair.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct Sums {
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
        [0, 2].map(|cost| {
            let parts: Vec<[f64; 2]> = self.pairs.iter().map(|pair| [pair[cost], pair[cost + 1]]).collect();
            linearised(&parts)
        })
    }

    /// What each pair's first trial costs beyond the ratio of both subjects together, less the second.
    pub fn exchangeable(&self) -> Vec<f64> {
        let count = self.total(1) + self.total(3);
        let (ratio, mean) = ((self.total(0) + self.total(2)) / count, count / 2.0 / self.pairs.len() as f64);
        let difference = |[cost, count, other, others]: &[f64; 4]| {
            ((cost - ratio * count) - (other - ratio * others)) / mean
        };
        self.pairs.iter().map(difference).collect()
    }

    /// The interval of the difference of the two ratios, from resampled pairs.
    pub fn interval(&self, confidence: f64) -> Option<[f64; 2]> {
        statistic_interval(self.pairs.len(), confidence, |rows| difference(&self.pairs, rows))
    }
}

/// The linearised values of costs and rescuees of one subject, trial by trial; none without rescuees.
pub fn linearised(parts: &[[f64; 2]]) -> Vec<f64> {
    let [cost, count] = [0, 1].map(|part: usize| parts.iter().map(|trial| trial[part]).sum::<f64>());
    if count <= 0.0 {
        return Vec::new();
    }
    let (ratio, mean) = (cost / count, count / parts.len() as f64);
    parts.iter().map(|[cost, count]| ratio + (cost - ratio * count) / mean).collect()
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
    use crate::wilcoxon::SignedRank;

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
        Sums { pairs: (0..pairs).map(|_| pair()).collect() }
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

    /// Four in five trials of equal subjects have nobody rescued, and a cost that does not depend on it.
    #[test]
    fn a_test_of_equal_ratios_keeps_its_level() {
        let mut draws = ChaCha8Rng::seed_from_u64(3);
        let mut trial = || {
            let count = (10.0 * draws.random::<f64>() - 7.0).floor().max(0.0);
            [8.0 * count + 4.0 + draws.random::<f64>(), count]
        };
        let mut is_found = |_: &u32| {
            let pairs = (0..50).map(|_| [trial(), trial()]).map(|[a, b]| [a[0], a[1], b[0], b[1]]);
            SignedRank::of(&Sums { pairs: pairs.collect() }.exchangeable()).p < 0.05
        };
        let found = (0..400).filter(|test| is_found(test)).count();
        assert!((8..=34).contains(&found), "{found} of 400");
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
