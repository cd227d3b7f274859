//! `xtask coverage [REPETITIONS]`: how often each kind of interval holds the true value, and how often
//! verdicts of `usar test` are wrong, over many synthetic experiments. The tables are in docs/experiments.md.

mod verdicts;

use std::process::ExitCode;

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, Exp, StandardNormal};
use rayon::prelude::*;
use statistics::bootstrap::{Width, bca_interval, bca_ratio_interval, statistic_interval};
use statistics::sensitivity::{Block, effects, shares};

/// Default number of experiments of each row.
const REPETITIONS: u64 = 10_000;

/// Sequential tests for each experiment of an interval: wrong verdicts are rarer than intervals that miss.
const TESTS: u64 = 2;

/// Resamples of an interval of means. They are fewer than in results, which changes a limit by a hundredth
/// of the interval's width.
const RESAMPLES: usize = 2_000;

type Interval = Option<[f64; 2]>;

/// One synthetic experiment: whether its interval holds the truth.
type Experiment = fn(&mut ChaCha8Rng) -> Option<bool>;

const ROWS: [(&str, Experiment); 10] = [
    ("mean difference, 10 pairs, normal", |draws| mean(draws, 10, |draws| StandardNormal.sample(draws), 0.0)),
    ("mean difference, 10 pairs, exponential", |draws| mean(draws, 10, exponential, 1.0)),
    ("mean difference, 50 pairs, exponential", |draws| mean(draws, 50, exponential, 1.0)),
    ("interaction, 20 seeds, normal", |draws| {
        let difference = |draws: &mut ChaCha8Rng| -> f64 {
            (0..4).map(|i| if i % 3 == 0 { 1.0 } else { -1.0 } * normal(draws)).sum()
        };
        mean(draws, 20, difference, 0.0)
    }),
    ("equivalence at 90 %, 20 pairs, normal", |draws| {
        let values: Vec<f64> = (0..20).map(|_| normal(draws)).collect();
        holds(bca_interval(&values, 0.90, RESAMPLES, 1, Width::Expanded), 0.0)
    }),
    ("ratio of sums, 20 trials", |draws| {
        let pairs: Vec<[f64; 2]> = (0..20).map(|_| cost(draws, 8.0)).collect();
        holds(bca_ratio_interval(&pairs, 0.95, RESAMPLES, 1), 8.0 + 4.0 / 2.0)
    }),
    ("difference of ratios of sums, 20 pairs", |draws| ratios(draws, 20)),
    ("difference of ratios of sums, 100 pairs", |draws| ratios(draws, 100)),
    ("mu* of elementary effects, 20 trajectories", |draws| {
        let found: Vec<f64> = (0..20).map(|_| 2.0 + normal(draws)).collect();
        // E|N(2, 1)| = sqrt(2 / pi) exp(-2) + 2 (1 - 2 Phi(-2))
        holds(effects(&found)?.size.interval, 2.016_98)
    }),
    ("Sobol index alone and in all, 64 samples", |draws| {
        let blocks: Vec<Block> = (0..64).map(|_| block(draws)).collect();
        let found = shares(&blocks, 0)?;
        // Of x + 2 y + 2 x y over [-1/2, 1/2] each: variances 1/12, 4/12, 4/144.
        let whole = 1.0 / 12.0 + 4.0 / 12.0 + 4.0 / 144.0;
        let first = holds(found.first.interval, 1.0 / 12.0 / whole)?;
        let total = holds(found.total.interval, (1.0 / 12.0 + 4.0 / 144.0) / whole)?;
        Some(if draws.random::<bool>() { first } else { total })
    }),
];

fn normal(draws: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(draws)
}

fn exponential(draws: &mut ChaCha8Rng) -> f64 {
    Exp::new(1.0).map_or(f64::NAN, |exponential| exponential.sample(draws))
}

fn holds(interval: Interval, truth: f64) -> Option<bool> {
    let [low, high] = interval?;
    Some(low <= truth && truth <= high)
}

fn mean(draws: &mut ChaCha8Rng, pairs: usize, draw: fn(&mut ChaCha8Rng) -> f64, truth: f64) -> Option<bool> {
    let values: Vec<f64> = (0..pairs).map(|_| draw(draws)).collect();
    holds(bca_interval(&values, 0.95, RESAMPLES, 1, Width::Expanded), truth)
}

/// Cost and rescuees of a trial: zero to four rescuees, each with this cost, and a fixed cost of 4.
fn cost(draws: &mut ChaCha8Rng, each: f64) -> [f64; 2] {
    let count = f64::from(draws.random_range(0..5_u32));
    [each * count + 4.0 + normal(draws), count]
}

fn ratios(draws: &mut ChaCha8Rng, pairs: usize) -> Option<bool> {
    let pairs: Vec<[[f64; 2]; 2]> = (0..pairs).map(|_| [cost(draws, 8.0), cost(draws, 6.0)]).collect();
    let difference = |rows: &[usize]| {
        let sum = |policy: usize, part: usize| rows.iter().map(|row| pairs[*row][policy][part]).sum::<f64>();
        (sum(0, 1) > 0.0 && sum(1, 1) > 0.0).then(|| sum(0, 0) / sum(0, 1) - sum(1, 0) / sum(1, 1))
    };
    holds(statistic_interval(pairs.len(), 0.95, difference), 2.0)
}

fn block(draws: &mut ChaCha8Rng) -> Block {
    let function = |[x, y]: [f64; 2]| x + 2.0 * y + 2.0 * x * y;
    let mut place = || [draws.random::<f64>() - 0.5, draws.random::<f64>() - 0.5];
    let (a, b) = (place(), place());
    Block { a: function(a), b: function(b), mixed: vec![function([b[0], a[1]]), function([a[0], b[1]])] }
}

/// Prints the tables.
pub fn run(arguments: &[String]) -> ExitCode {
    let Ok(repetitions) = arguments.first().map_or(Ok(REPETITIONS), |count| count.parse::<u64>()) else {
        eprintln!("coverage: must be a number of repetitions, found {:?}", arguments[0]);
        return ExitCode::from(2);
    };
    println!("| interval | experiments | holds the truth |\n| --- | ---: | ---: |");
    for (row, (name, experiment)) in ROWS.into_iter().enumerate() {
        let one = |number: u64| {
            let mut draws = ChaCha8Rng::seed_from_u64(number);
            draws.set_stream(row as u64);
            experiment(&mut draws)
        };
        let found: Vec<bool> = (0..repetitions).into_par_iter().filter_map(one).collect();
        let held = found.iter().filter(|held| **held).count();
        println!("| {name} | {} | {:.1} % |", found.len(), 100.0 * held as f64 / found.len().max(1) as f64);
    }
    verdicts::print(TESTS * repetitions);
    ExitCode::SUCCESS
}
