//! Costs per rescuee, compared as ratios of sums if some trial has few rescuees or none.
//!
//! The trials with the smallest denominators dominate the mean of the trials' own ratios, and trials
//! without rescuees are missing from it. The ratio of the sums over all trials has neither defect. A
//! trial's *linearised value* is its contribution to that ratio: R + (cost - R rescuees) / (mean of
//! rescuees), where R is the ratio of both cells together. The mean of a cell's linearised values is the
//! cell's ratio of sums. Tests and standard deviations of these values are therefore valid for the ratio.

use std::collections::BTreeSet;

use super::cell::{Cell, same};
use crate::stats::Moments;
use crate::stats::bootstrap::statistic_interval;
use crate::sweep::folder::Folder;

/// Mean and standard deviation of a metric in a cell. For a cost per rescuee they are those of the linearised
/// values: the mean is the sum of the costs over the sum of the rescuees, so that trials without rescuees
/// count, and a total lies between its tasks but for what robots spent outside groups.
#[must_use]
pub fn moments_of(folder: &Folder, cell: Cell, metric: usize) -> Moments {
    let (experiment, (case, policy)) = (folder.experiment(), cell);
    let Some([cost, count]) = experiment.metrics.sums(metric) else {
        return Moments::of(&folder.values(case, policy, metric));
    };
    let trials = experiment.trials_of(case, folder.manifest().shard);
    let value = |trial, metric| folder.value((case, policy, trial), metric);
    let parts: Vec<[f64; 2]> =
        trials.filter_map(|trial| Some([value(trial, cost)?, value(trial, count)?])).collect();
    let [cost, count] = [0, 1].map(|part: usize| parts.iter().map(|trial| trial[part]).sum::<f64>());
    if count <= 0.0 {
        return Moments::of(&[]);
    }
    let (ratio, mean) = (cost / count, count / parts.len() as f64);
    let values = parts.iter().map(|[cost, count]| ratio + (cost - ratio * count) / mean);
    Moments::of(&values.collect::<Vec<f64>>())
}

/// If a trial has fewer rescuees than this, ratios of sums are compared. One rescuee more or less would
/// change the trial's own ratio by a fifth.
pub const FEW: f64 = 5.0;

/// Costs and rescuees of both cells, pair by pair.
#[derive(Debug, Default, Clone, PartialEq)]
pub(super) struct Sums {
    /// Number of each pair's trial, ascending.
    pub trials: Vec<u32>,
    /// Cost and rescuees of the first cell, then of the second.
    pub pairs: Vec<[f64; 4]>,
}

impl Sums {
    /// The sums of a metric. `None` if the metric is not a ratio, if every trial has a large enough
    /// denominator, or if a cell has no rescuees at all.
    pub fn of(folder: &Folder, metric: usize, [a, b]: [Cell; 2]) -> Option<Self> {
        let experiment = folder.experiment();
        let [cost, count] = experiment.metrics.sums(metric)?;
        let (mut sums, mut known) = (Self::default(), BTreeSet::new());
        for trial in experiment.trials_of(a.0, folder.manifest().shard) {
            let value = |(case, policy): Cell, metric| folder.value((case, policy, trial), metric);
            let parts = |cell: Cell| Some([value(cell, cost)?, value(cell, count)?]);
            let is_new = known.insert(same(folder, &[a, b], trial));
            if let (true, Some([cost_a, count_a]), Some([cost_b, count_b])) = (is_new, parts(a), parts(b)) {
                sums.trials.push(trial);
                sums.pairs.push([cost_a, count_a, cost_b, count_b]);
            }
        }
        let is_few = sums.pairs.iter().any(|pair| pair[1] < FEW || pair[3] < FEW);
        (is_few && sums.total(1) > 0.0 && sums.total(3) > 0.0).then_some(sums)
    }

    fn total(&self, part: usize) -> f64 {
        self.pairs.iter().map(|pair| pair[part]).sum()
    }

    /// The linearised values of both cells.
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
