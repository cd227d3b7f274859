//! Costs per rescuee of the cells of a sweep, as ratios of sums.

use statistics::Moments;
use statistics::comparison::{Repeats, Sums};

use super::cell::{Cell, hashes};
use crate::sweep::folder::Folder;

/// Mean and standard deviation of a metric in a cell. For a cost per rescuee they are those of the linearised
/// values: the mean is the sum of the costs over the sum of the rescuees, so that trials without rescuees
/// count, and a total lies between its tasks but for what robots spent outside groups.
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

/// The sums of a metric. `None` if the metric is not a ratio, if every trial has a large enough
/// denominator, or if a cell has no rescuees at all.
pub(super) fn sums_of(folder: &Folder, metric: usize, [a, b]: [Cell; 2]) -> Option<Sums> {
    let experiment = folder.experiment();
    let [cost, count] = experiment.metrics.sums(metric)?;
    let (mut sums, mut repeats) = (Sums::default(), Repeats::default());
    for trial in experiment.trials_of(a.0, folder.manifest().shard) {
        let value = |(case, policy): Cell, metric| folder.value((case, policy, trial), metric);
        let parts = |cell: Cell| Some([value(cell, cost)?, value(cell, count)?]);
        let is_new = repeats.is_new(trial, &hashes(folder, &[a, b], trial));
        if let (true, Some([cost_a, count_a]), Some([cost_b, count_b])) = (is_new, parts(a), parts(b)) {
            sums.trials.push(trial);
            sums.pairs.push([cost_a, count_a, cost_b, count_b]);
        }
    }
    sums.are_compared().then_some(sums)
}
