//! Values of two cells of a sweep, paired by seed.

use std::collections::BTreeSet;

use super::cell::{Cell, same};
use super::sums::Sums;
use crate::stats::bootstrap::interval;
use crate::sweep::folder::{Folder, Measured};

/// The values of two cells in one metric.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct Pairs {
    /// Values of the first cell.
    pub a: Vec<f64>,
    /// Values of the second cell.
    pub b: Vec<f64>,
    /// Pairs that repeat others, to the last state: they are left out.
    pub(super) repeated: usize,
    /// Pairs with at least one failed trial.
    pub(super) failed: usize,
    /// Pairs with at least one trial that has not been run.
    pub(super) missing: usize,
    /// Pairs with at least one trial in which the metric is undefined.
    pub(super) undefined: usize,
    /// The sums, if ratios of sums are compared. The values are then linearised.
    pub(super) sums: Option<Sums>,
}

impl Pairs {
    /// The pairs of two cells.
    #[must_use]
    pub fn of(folder: &Folder, metric: usize, [a, b]: [Cell; 2]) -> Self {
        let mut pairs = Self::default();
        let mut known = BTreeSet::new();
        for trial in folder.experiment().trials_of(a.0, folder.manifest().shard) {
            if !known.insert(same(folder, &[a, b], trial)) {
                pairs.repeated += 1;
                continue;
            }
            let result = |(case, policy): Cell| folder.results().get(&(case, policy, trial));
            let value = |measured: &Measured| Some(measured.metrics.as_ref()?.get(metric));
            match (result(a), result(b)) {
                (Some(a), Some(b)) => match (value(a), value(b)) {
                    (Some(Some(a)), Some(Some(b))) => {
                        pairs.a.push(a);
                        pairs.b.push(b);
                    }
                    (Some(_), Some(_)) => pairs.undefined += 1,
                    _ => pairs.failed += 1,
                },
                _ => pairs.missing += 1,
            }
        }
        if let Some(sums) = Sums::of(folder, metric, [a, b]) {
            [pairs.a, pairs.b] = sums.linearised();
            pairs.undefined = 0;
            pairs.sums = Some(sums);
        }
        pairs
    }

    /// The interval of the mean difference, or of the difference of ratios of sums.
    pub(super) fn interval(&self, confidence: f64) -> Option<[f64; 2]> {
        match &self.sums {
            Some(sums) => sums.interval(confidence),
            None => interval(&self.differences(), confidence),
        }
    }

    /// First minus second, by trial; `None` where either has no value.
    pub(super) fn by_trial(folder: &Folder, metric: usize, [a, b]: [Cell; 2]) -> Vec<Option<f64>> {
        let trials = 1..=folder.experiment().trials;
        if let Some(sums) = Sums::of(folder, metric, [a, b]) {
            let [a, b] = sums.linearised();
            let place = |trial: u32| sums.trials.binary_search(&trial).ok();
            return trials.map(|trial| place(trial).map(|place| a[place] - b[place])).collect();
        }
        let value = |(case, policy): Cell, trial| folder.value((case, policy, trial), metric);
        trials.map(|trial| Some(value(a, trial)? - value(b, trial)?)).collect()
    }

    /// First minus second, pair by pair.
    #[must_use]
    pub fn differences(&self) -> Vec<f64> {
        self.a.iter().zip(&self.b).map(|(a, b)| a - b).collect()
    }
}
