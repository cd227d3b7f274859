//! Sensitivity indices of a function of several parameters, from blocks of evaluations: elementary effects
//! (Morris 1991, with mu* of Campolongo et al. 2007) and variance shares (Sobol' 1993; first order after
//! Saltelli et al. 2010, total after Jansen 1999). Intervals are bootstraps over the blocks, which are
//! independent of each other.

use serde::Serialize;

use super::Moments;
use super::bootstrap::{interval, statistic_interval};

/// Confidence of the intervals.
const CONFIDENCE: f64 = 0.95;

/// A number with its 95 % bootstrap interval, if it has one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Known {
    /// The number.
    pub value: f64,
    /// Its interval; `None` with fewer than two blocks, or if a resample has no value.
    pub interval: Option<[f64; 2]>,
}

/// Summary of a parameter's elementary effects.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Effects {
    /// mu*: mean size of the effects. How much the parameter matters.
    pub size: Known,
    /// mu: mean effect. Its sign is the direction.
    pub mean: Known,
    /// sigma: standard deviation of the effects. Large for a parameter that interacts with others or has a
    /// nonlinear effect.
    pub spread: Known,
}

/// The summary of a parameter's elementary effects, one from each block; `None` without any.
pub fn effects(effects: &[f64]) -> Option<Effects> {
    let sizes: Vec<f64> = effects.iter().map(|effect| effect.abs()).collect();
    let spread = |rows: &[usize]| Moments::of(&rows.iter().map(|row| effects[*row]).collect::<Vec<_>>()).sd;
    let all: Vec<usize> = (0..effects.len()).collect();
    Some(Effects {
        size: Known { value: Moments::of(&sizes).mean?, interval: interval(&sizes, CONFIDENCE) },
        mean: Known { value: Moments::of(effects).mean?, interval: interval(effects, CONFIDENCE) },
        spread: Known {
            value: spread(&all).unwrap_or(0.0),
            interval: statistic_interval(effects.len(), CONFIDENCE, spread),
        },
    })
}

/// Values of a block: at two independent points `a` and `b`, and at `a` with each parameter in turn taken
/// from `b`.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// At the first point.
    pub a: f64,
    /// At the second point.
    pub b: f64,
    /// At the first point with each parameter in turn taken from the second.
    pub mixed: Vec<f64>,
}

/// A parameter's shares of the variance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Shares {
    /// First-order index: the share of the variance that the parameter makes alone.
    pub first: Known,
    /// Total index: the share of the variance in which the parameter has any part.
    pub total: Known,
}

/// Mean and variance of the function over both points of the blocks; `None` if it is constant.
fn moments(blocks: &[Block], rows: &[usize]) -> Option<(f64, f64)> {
    let values = || rows.iter().flat_map(|row| [blocks[*row].a, blocks[*row].b]);
    let count = 2.0 * rows.len() as f64;
    let mean = values().sum::<f64>() / count;
    let variance = values().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
    (variance > 0.0).then_some((mean, variance))
}

fn mean_over(rows: &[usize], of: impl Fn(usize) -> f64) -> f64 {
    rows.iter().map(|row| of(*row)).sum::<f64>() / rows.len() as f64
}

/// First-order index over these blocks.
fn first_order(blocks: &[Block], parameter: usize, rows: &[usize]) -> Option<f64> {
    let (mean, variance) = moments(blocks, rows)?;
    let part = |Block { a, b, mixed }: &Block| (b - mean) * (mixed[parameter] - a);
    Some(mean_over(rows, |row| part(&blocks[row])) / variance)
}

/// Total index over these blocks.
fn total_order(blocks: &[Block], parameter: usize, rows: &[usize]) -> Option<f64> {
    let (_, variance) = moments(blocks, rows)?;
    let part = |Block { a, mixed, .. }: &Block| (a - mixed[parameter]).powi(2) / 2.0;
    Some(mean_over(rows, |row| part(&blocks[row])) / variance)
}

/// The shares of one parameter, by its place; `None` for fewer than two blocks or a constant function.
pub fn shares(blocks: &[Block], parameter: usize) -> Option<Shares> {
    let first = known(blocks, |rows| first_order(blocks, parameter, rows))?;
    let total = known(blocks, |rows| total_order(blocks, parameter, rows))?;
    Some(Shares { first, total })
}

/// The share of the variance that both points of a block have in common. Its source is what the block's
/// evaluations share besides parameters, such as the seeds of their trials.
pub fn common_share(blocks: &[Block]) -> Option<Known> {
    known(blocks, |rows| {
        let (mean, variance) = moments(blocks, rows)?;
        Some(mean_over(rows, |row| (blocks[row].a - mean) * (blocks[row].b - mean)) / variance)
    })
}

fn known(blocks: &[Block], statistic: impl Fn(&[usize]) -> Option<f64>) -> Option<Known> {
    let all: Vec<usize> = (0..blocks.len()).collect();
    let value = statistic(&all).filter(|_| blocks.len() > 1)?;
    Some(Known { value, interval: statistic_interval(blocks.len(), CONFIDENCE, statistic) })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    use super::*;

    type Function = fn(&[f64]) -> f64;

    /// The function of Ishigami & Homma (1990) with a = 7, b = 0.1, each parameter over [-pi, pi].
    fn ishigami(places: &[f64]) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|i: usize| PI * (2.0 * places[i] - 1.0));
        x.sin() + 7.0 * y.sin().powi(2) + 0.1 * z.powi(4) * x.sin()
    }

    /// Coefficients of Sobol's G; parameters with small coefficients matter.
    const G: [f64; 4] = [0.0, 1.0, 4.5, 99.0];

    fn g(places: &[f64]) -> f64 {
        places.iter().zip(G).map(|(x, a)| ((4.0 * x - 2.0).abs() + a) / (1.0 + a)).product()
    }

    fn blocks(function: Function, parameters: usize, count: usize, seed: u64) -> Vec<Block> {
        let mut draws = ChaCha8Rng::seed_from_u64(seed);
        let mut point = || (0..parameters).map(|_| draws.random::<f64>()).collect::<Vec<f64>>();
        let block = |(a, b): (Vec<f64>, Vec<f64>)| {
            let mixed = |i: usize| {
                let mut mixed = a.clone();
                mixed[i] = b[i];
                function(&mixed)
            };
            Block { a: function(&a), b: function(&b), mixed: (0..parameters).map(mixed).collect() }
        };
        (0..count).map(|_| block((point(), point()))).collect()
    }

    /// First-order and total indices of `G`, in closed form.
    fn exact_g() -> Vec<[f64; 2]> {
        let parts = G.map(|a| 1.0 / (3.0 * (1.0 + a) * (1.0 + a)));
        let whole: f64 = parts.iter().map(|part| 1.0 + part).product::<f64>() - 1.0;
        let others = |i: usize| {
            parts.iter().enumerate().filter(|(k, _)| *k != i).map(|(_, p)| 1.0 + p).product::<f64>()
        };
        (0..4).map(|i| [parts[i] / whole, parts[i] * others(i) / whole]).collect()
    }

    #[track_caller]
    fn are_near(function: Function, exact: &[[f64; 2]], seed: u64) {
        let blocks = blocks(function, exact.len(), 8_000, seed);
        let all: Vec<usize> = (0..blocks.len()).collect();
        for (i, [first, total]) in exact.iter().enumerate() {
            let found = [first_order(&blocks, i, &all).unwrap(), total_order(&blocks, i, &all).unwrap()];
            assert!((found[0] - first).abs() < 0.04 && (found[1] - total).abs() < 0.03, "{i}: {found:?}");
        }
    }

    #[test]
    fn shares_of_ishigamis_function_are_those_of_its_formula() {
        // V1 = (1 + b pi^4 / 5)^2 / 2, V2 = a^2 / 8, V13 = 8 b^2 pi^8 / 225
        are_near(ishigami, &[[0.3139, 0.5576], [0.4424, 0.4424], [0.0, 0.2437]], 1);
    }

    #[test]
    fn shares_of_sobols_g_are_those_of_its_formula() {
        are_near(g, &exact_g(), 2);
    }

    /// The generator of the C standard's example, so that another program can draw the same numbers.
    struct Lcg(u64);

    impl Lcg {
        fn draw(&mut self) -> f64 {
            self.0 = (1_103_515_245 * self.0 + 12_345) % 2_147_483_648;
            self.0 as f64 / 2_147_483_648.0
        }
    }

    /// `SALib` 1.6.0, `sobol.analyze(calc_second_order=False)`, on the same 64 blocks. `SALib` centres on
    /// the mean of all values, and these shares on the mean of A and B. First-order indices differ by that
    /// much.
    #[test]
    fn shares_are_salibs() {
        let mut draws = Lcg(12_345);
        let block = |_| {
            let mut point = || (0..3).map(|_| draws.draw()).collect::<Vec<f64>>();
            let (a, b) = (point(), point());
            let mixed = |i: usize| {
                let mut mixed = a.clone();
                mixed[i] = b[i];
                ishigami(&mixed)
            };
            Block { a: ishigami(&a), b: ishigami(&b), mixed: (0..3).map(mixed).collect() }
        };
        let blocks: Vec<Block> = (0..64).map(block).collect();
        let first = [0.317_874_725_4, 0.349_588_392_3, 0.000_733_589_3];
        let total = [0.444_994_247_7, 0.375_424_080_7, 0.264_316_119_9];
        for i in 0..3 {
            let found = shares(&blocks, i).unwrap();
            assert!((found.total.value - total[i]).abs() < 1e-9, "{i}: {found:?}");
            assert!((found.first.value - first[i]).abs() < 0.01, "{i}: {found:?}");
        }
    }

    /// `SALib` 1.6.0, `morris.analyze`, on the same 12 trajectories.
    #[test]
    fn effects_are_salibs() {
        let mut draws = Lcg(777);
        let mut found = vec![Vec::new(); 3];
        for _ in 0..12 {
            let bases = [(); 3].map(|()| if draws.draw() < 0.5 { 0.0 } else { 1.0 / 3.0 });
            let ups = [(); 3].map(|()| draws.draw() < 0.5);
            let mut place = [0, 1, 2].map(|i: usize| if ups[i] { bases[i] } else { bases[i] + 2.0 / 3.0 });
            for i in 0..3 {
                let before = (ishigami(&place), place[i]);
                place[i] = if ups[i] { bases[i] + 2.0 / 3.0 } else { bases[i] };
                found[i].push((ishigami(&place) - before.0) / (place[i] - before.1));
            }
        }
        let salib = [
            [7.704_054_111_6, 7.704_054_111_6, 6.526_654_669_3],
            [7.875, -2.625, 7.754_763_931_7],
            [6.248_796_103_3, 4.165_864_068_9, 8.140_168_551_4],
        ];
        for (of, [size, mean, spread]) in found.iter().zip(salib) {
            let of = effects(of).unwrap();
            let apart = [of.size.value - size, of.mean.value - mean, of.spread.value - spread];
            assert!(apart.iter().all(|apart| apart.abs() < 1e-9), "{of:?}");
        }
    }

    /// About 95 % of studies have an interval that holds the true index; `xtask coverage` checks more of
    /// them.
    #[test]
    fn intervals_of_shares_hold_the_true_ones() {
        let exact = exact_g();
        let studies = 100;
        let mut held = [0; 2];
        for study in 0..studies {
            let blocks = blocks(g, 4, 150, 10 + study);
            let found = shares(&blocks, 1).unwrap();
            for (held, (known, truth)) in held.iter_mut().zip([found.first, found.total].iter().zip(exact[1]))
            {
                let [low, high] = known.interval.unwrap();
                *held += usize::from(low <= truth && truth <= high);
            }
        }
        assert!(held.iter().all(|held| (86..=100).contains(held)), "{held:?} of {studies}");
    }

    #[test]
    fn effects_of_a_straight_line_are_its_slope() {
        let found = effects(&[2.0, 2.0, 2.0]).unwrap();
        assert_eq!((found.size.value, found.mean.value, found.spread.value), (2.0, 2.0, 0.0));
        let turned = effects(&[3.0, -3.0, 3.0, -3.0]).unwrap();
        assert!(
            (turned.size.value - 3.0).abs() < 1e-12
                && turned.mean.value.abs() < 1e-12
                && turned.spread.value > 3.0
        );
        assert_eq!(effects(&[]), None);
    }

    #[test]
    fn what_a_block_has_in_common_is_told_apart() {
        let mut draws = ChaCha8Rng::seed_from_u64(3);
        let mut blocks = Vec::new();
        for _ in 0..1_000 {
            let (common, x, y) = (draws.random::<f64>(), draws.random::<f64>(), draws.random::<f64>());
            blocks.push(Block { a: common + x, b: common + y, mixed: vec![common + y] });
        }
        let share = common_share(&blocks).unwrap();
        assert!((share.value - 0.5).abs() < 0.08, "{share:?}");
        let constant = Block { a: 1.0, b: 1.0, mixed: vec![1.0] };
        assert_eq!(common_share(&[constant.clone(), constant.clone()]), None);
        assert_eq!(shares(&[constant.clone(), constant], 0), None);
    }
}
