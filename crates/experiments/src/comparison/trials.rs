//! Quantities of trials, and how they differ. Here, and nowhere else, trials of two cells are paired by seed,
//! repeats are told apart, and a metric is a mean or a ratio of sums.

use statistics::Moments;
use statistics::comparison::{Pairs, Repeats, Sums, linearised};

use crate::metric::Catalogue;
use crate::sweep::folder::{Folder, Measured, Results};

/// A cell of a sweep: the places of a case and of a policy.
pub type Cell = (usize, usize);

/// A metric, by its place, of the trials of a cell.
pub type Quantity = (Cell, usize);

/// Trials of the same numbers in all cells.
pub struct Trials<'t> {
    metrics: &'t Catalogue,
    results: &'t Results,
    numbers: Vec<u32>,
}

impl<'t> Trials<'t> {
    /// The trials of these numbers.
    pub fn new(metrics: &'t Catalogue, results: &'t Results, numbers: impl Iterator<Item = u32>) -> Self {
        Self { metrics, results, numbers: numbers.collect() }
    }

    /// The trials that a folder has, or is to have, of a case.
    pub fn of(folder: &'t Folder, case: usize) -> Self {
        let experiment = folder.experiment();
        let numbers = experiment.trials_of(case, folder.manifest().shard);
        Self::new(&experiment.metrics, folder.results(), numbers)
    }

    /// Values of a quantity whose mean is what is said of it; none of one that is censored in a trial. For a
    /// cost per rescuee they are linearised: the mean is the sum of the costs over the sum of the rescuees,
    /// so that trials without rescuees count, and a total lies between its tasks but for what robots spent
    /// outside groups.
    pub fn values(&self, quantity: Quantity) -> Vec<f64> {
        let (cell, metric) = quantity;
        if self.metrics[metric].is_censored && self.in_each(quantity).contains(&None) {
            return Vec::new();
        }
        let of = |metric: usize| self.numbers.iter().map(move |trial| self.value((cell, metric), *trial));
        match self.metrics.sums(metric) {
            None => of(metric).flatten().collect(),
            Some([cost, count]) => {
                let parts = of(cost).zip(of(count)).filter_map(|(cost, count)| Some([cost?, count?]));
                linearised(&parts.collect::<Vec<_>>())
            }
        }
    }

    /// A quantity in each trial that was run; `None` where it has no value.
    pub fn in_each(&self, quantity: Quantity) -> Vec<Option<f64>> {
        let is_run = |trial: &&u32| self.measured(quantity, **trial).is_some();
        self.numbers.iter().filter(is_run).map(|trial| self.value(quantity, *trial)).collect()
    }

    /// Mean and standard deviation of a quantity.
    pub fn moments(&self, quantity: Quantity) -> Moments {
        Moments::of(&self.values(quantity))
    }

    /// Two quantities, paired by seed.
    pub fn pairs(&self, pair: [Quantity; 2]) -> Pairs {
        let new = self.new_ones(&[pair]);
        let repeated = self.numbers.len() - new.len();
        Pairs { repeated, ..self.paired(&new, pair) }
    }

    /// Several pairs of quantities over the same trials: those that repeat no other in all cells together,
    /// and in which all quantities have a value. Differences of one seed stay together.
    pub fn joint(&self, pairs: &[[Quantity; 2]]) -> Vec<Pairs> {
        let mut trials = self.new_ones(pairs);
        trials.retain(|trial| pairs.iter().all(|pair| self.parts(*pair, *trial).is_some()));
        let found: Vec<Pairs> = pairs.iter().map(|pair| self.paired(&trials, *pair)).collect();
        let is_whole = found.iter().all(|pairs| pairs.a.len() == trials.len());
        if is_whole { found } else { vec![Pairs::default(); pairs.len()] } // a cell has no rescuees at all
    }

    fn measured(&self, quantity: Quantity, trial: u32) -> Option<&Measured> {
        let ((case, policy), _) = quantity;
        self.results.get(&(case, policy, trial))
    }

    fn value(&self, quantity: Quantity, trial: u32) -> Option<f64> {
        self.measured(quantity, trial)?.metrics.as_ref()?.get(quantity.1)
    }

    /// The trials that repeat no other.
    fn new_ones(&self, pairs: &[[Quantity; 2]]) -> Vec<u32> {
        let mut repeats = Repeats::default();
        let hash = |quantity, trial| self.measured(quantity, trial).map_or(0, |measured| measured.hash);
        let hashes = |trial| pairs.iter().flatten().map(|of| hash(*of, trial)).collect::<Vec<_>>();
        self.numbers.iter().copied().filter(|trial| repeats.is_new(*trial, &hashes(*trial))).collect()
    }

    fn paired(&self, trials: &[u32], pair: [Quantity; 2]) -> Pairs {
        let mut pairs = Pairs::default();
        for trial in trials {
            match pair.map(|quantity| self.measured(quantity, *trial).map(|it| it.metrics.as_ref())) {
                [Some(Some(a)), Some(Some(b))] => match (a.get(pair[0].1), b.get(pair[1].1)) {
                    (Some(a), Some(b)) => {
                        pairs.a.push(a);
                        pairs.b.push(b);
                    }
                    _ => pairs.undefined += 1,
                },
                [Some(_), Some(_)] => pairs.failed += 1,
                _ => pairs.missing += 1,
            }
        }
        if pairs.undefined > 0 && pair.iter().any(|(_, metric)| self.metrics[*metric].is_censored) {
            return Pairs { a: Vec::new(), b: Vec::new(), ..pairs };
        }
        match self.sums(trials, pair) {
            Some(sums) => pairs.of_sums(sums),
            None => pairs,
        }
    }

    /// The sums behind two quantities. `None` if one is not a ratio, if every trial has a large enough
    /// denominator, or if a cell has no rescuees at all.
    fn sums(&self, trials: &[u32], pair: [Quantity; 2]) -> Option<Sums> {
        self.ratios(pair)?;
        let parts = trials.iter().filter_map(|trial| self.parts(pair, *trial)?.try_into().ok());
        Some(Sums { pairs: parts.collect() }).filter(Sums::are_compared)
    }

    /// Cost and rescuees of both quantities, if they are ratios.
    fn ratios(&self, pair: [Quantity; 2]) -> Option<[Quantity; 4]> {
        let [a, b] = pair.map(|(cell, metric)| Some(self.metrics.sums(metric)?.map(|part| (cell, part))));
        let ([cost_a, count_a], [cost_b, count_b]) = a.zip(b)?;
        Some([cost_a, count_a, cost_b, count_b])
    }

    /// What two quantities are made of in a trial: both costs and rescuees, or both values.
    fn parts(&self, pair: [Quantity; 2], trial: u32) -> Option<Vec<f64>> {
        let parts = self.ratios(pair).map_or(pair.to_vec(), |parts| parts.to_vec());
        parts.into_iter().map(|part| self.value(part, trial)).collect()
    }
}
