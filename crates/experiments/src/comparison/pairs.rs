//! Values of two cells of a sweep, paired by seed.

use statistics::comparison::{Pairs, Repeats};

use super::cell::{Cell, hashes};
use super::sums::sums_of;
use crate::sweep::folder::{Folder, Measured};

/// The values of two cells in one metric, paired by seed.
pub fn pairs_of(folder: &Folder, metric: usize, [a, b]: [Cell; 2]) -> Pairs {
    let (mut pairs, mut repeats) = (Pairs::default(), Repeats::default());
    for trial in folder.experiment().trials_of(a.0, folder.manifest().shard) {
        if !repeats.is_new(trial, &hashes(folder, &[a, b], trial)) {
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
    match sums_of(folder, metric, [a, b]) {
        Some(sums) => pairs.of_sums(sums),
        None => pairs,
    }
}

/// First minus second, by trial; `None` where either has no value.
pub(super) fn by_trial(folder: &Folder, metric: usize, [a, b]: [Cell; 2]) -> Vec<Option<f64>> {
    let trials = 1..=folder.experiment().trials;
    if let Some(sums) = sums_of(folder, metric, [a, b]) {
        let [a, b] = sums.linearised();
        let place = |trial: u32| sums.trials.binary_search(&trial).ok();
        return trials.map(|trial| place(trial).map(|place| a[place] - b[place])).collect();
    }
    let value = |(case, policy): Cell, trial| folder.value((case, policy, trial), metric);
    trials.map(|trial| Some(value(a, trial)? - value(b, trial)?)).collect()
}
