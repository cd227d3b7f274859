//! Partitions of roles that are too large for the exact search: a deterministic local search.
//!
//! The search starts from the best partition by rank in one need's share, then swaps pairs of robots as long
//! as a swap improves the score. The result is not proven optimal. In large teams, [`super::gain`] tells of
//! most swaps that they lose.

use super::gain::{Gains, Spread};
use super::parts::{Partition, distinct_orders, in_order};
use super::scorer::{Scorer, TIE_TOLERANCE, add_pair, part_sums};
use rne_core::needs::shares_of;

/// Most swaps that are tried for one role.
const MAX_SWAPS: u64 = 1_000_000;

/// Most orders of the parts' sizes that are tried as starts.
const MAX_ORDERS: usize = 64;

/// A partition with the score of each pair of its parts.
struct Scored {
    part_of: Vec<usize>,
    sums: Vec<Vec<f64>>,
    /// Score of parts `i` and `j`, at `i * parts + j`, for `i < j`.
    pairs: Vec<f64>,
    total: f64,
}

impl Scored {
    fn new(part_of: Vec<usize>, rows: &[Vec<f64>], parts: usize, scorer: &mut Scorer) -> Self {
        let sums = part_sums(rows, &part_of, parts);
        let mut pairs = vec![f64::NEG_INFINITY; parts * parts];
        for i in 0..parts {
            for j in i + 1..parts {
                pairs[i * parts + j] = scorer.score(&sums[i], &sums[j]);
            }
        }
        let total = (0..parts)
            .flat_map(|i| (i + 1..parts).map(move |j| i * parts + j))
            .fold(f64::NEG_INFINITY, |total, at| add_pair(total, pairs[at]));
        Self { part_of, sums, pairs, total }
    }

    /// The total after a swap.
    fn total_with(&self, swap: &Swap<'_>, scorer: &mut Scorer) -> f64 {
        let Swap { parts: [low, high], sums: [new_low, new_high] } = *swap;
        let parts = self.sums.len();
        let sums = |part: usize| match part {
            part if part == low => new_low,
            part if part == high => new_high,
            part => &self.sums[part],
        };
        let mut total = f64::NEG_INFINITY;
        for i in 0..parts {
            for j in i + 1..parts {
                let is_same = [i, j].iter().all(|part| *part != low && *part != high);
                let score = if is_same { self.pairs[i * parts + j] } else { scorer.score(sums(i), sums(j)) };
                total = add_pair(total, score);
            }
        }
        total
    }
}

/// A swap of members between two parts, the lower first, with the sums of both after it.
struct Swap<'s> {
    parts: [usize; 2],
    sums: [&'s [f64]; 2],
}

/// A good partition into parts of these sizes, which must be above 0 and in ascending order.
pub(super) fn search(rows: &[Vec<f64>], sizes: &[usize], scorer: &mut Scorer) -> Partition {
    search_with(Spread::of(rows), rows, sizes, scorer)
}

fn search_with(spread: Spread, rows: &[Vec<f64>], sizes: &[usize], scorer: &mut Scorer) -> Partition {
    let best = best_ranked_start(rows, sizes, scorer);
    let mut search = LocalSearch { rows, spread, gains: None, scorer, best, searched: 0 };
    search.weigh_gains();
    while search.searched < MAX_SWAPS && search.improve() {}
    Partition {
        parts: in_order(&search.best.part_of, sizes.len()),
        runner_up: None,
        searched: search.searched,
        proven_optimal: false,
    }
}

/// The state of a search.
struct LocalSearch<'a> {
    rows: &'a [Vec<f64>],
    spread: Spread,
    /// What swaps in the best partition gain at most; `None` where each must be scored.
    gains: Option<Gains>,
    scorer: &'a mut Scorer,
    best: Scored,
    searched: u64,
}

impl LocalSearch<'_> {
    /// Tries to swap each pair of robots once, and keeps each swap that improves the score. Returns whether
    /// any did, but false once [`MAX_SWAPS`] is reached.
    fn improve(&mut self) -> bool {
        let parts = self.best.sums.len();
        let mut swapped = [self.best.sums[0].clone(), self.best.sums[0].clone()];
        let mut improved = false;
        for i in 0..self.rows.len() {
            for j in i + 1..self.rows.len() {
                if self.best.part_of[i] == self.best.part_of[j] {
                    continue;
                }
                if self.searched == MAX_SWAPS {
                    return false;
                }
                self.searched += 1;
                if self.improves([i, j], &mut swapped) {
                    let mut part_of = std::mem::take(&mut self.best.part_of);
                    part_of.swap(i, j);
                    self.best = Scored::new(part_of, self.rows, parts, self.scorer);
                    self.weigh_gains();
                    improved = true;
                }
            }
        }
        improved
    }

    /// Whether the swap of two robots of different parts improves the score. `swapped` is for the sums of
    /// both parts after it.
    fn improves(&mut self, [i, j]: [usize; 2], swapped: &mut [Vec<f64>; 2]) -> bool {
        let Self { rows, best, .. } = self;
        let (out, into) = if best.part_of[i] < best.part_of[j] { (i, j) } else { (j, i) };
        let [low, high] = [best.part_of[out], best.part_of[into]];
        if let Some(gains) = &mut self.gains
            && gains.at_most([low, high], [&rows[out], &rows[into]]) <= 0.0
        {
            return false;
        }
        for k in 0..rows[0].len() {
            swapped[0][k] = (best.sums[low][k] - rows[out][k] + rows[into][k]).max(0.0);
            swapped[1][k] = (best.sums[high][k] - rows[into][k] + rows[out][k]).max(0.0);
        }
        let swap = Swap { parts: [low, high], sums: [&swapped[0], &swapped[1]] };
        best.total_with(&swap, self.scorer) > best.total + TIE_TOLERANCE
    }

    fn weigh_gains(&mut self) {
        self.gains = if self.scorer.sort {
            None // a share's place depends on the others
        } else {
            Gains::new(&self.best.sums, self.scorer.direction, &self.spread)
        };
    }
}

fn best_ranked_start(rows: &[Vec<f64>], sizes: &[usize], scorer: &mut Scorer) -> Scored {
    let shares: Vec<Vec<f64>> = rows.iter().map(|row| shares_of(row)).collect();
    let orders: Vec<Vec<usize>> = if sizes.len() <= 4 {
        distinct_orders(sizes).into_iter().take(MAX_ORDERS).collect()
    } else {
        vec![sizes.to_vec(), sizes.iter().rev().copied().collect()]
    };
    let mut best: Option<Scored> = None;
    for need in 0..rows[0].len() {
        let ranked = ranked_by_share(&shares, need);
        for order in &orders {
            let mut part_of = vec![0; rows.len()];
            let parts = order.iter().enumerate().flat_map(|(part, size)| std::iter::repeat_n(part, *size));
            ranked.iter().zip(parts).for_each(|(robot, part)| part_of[*robot] = part);
            let start = Scored::new(part_of, rows, sizes.len(), scorer);
            if best.as_ref().is_none_or(|best| start.total > best.total + TIE_TOLERANCE) {
                best = Some(start);
            }
        }
    }
    best.unwrap_or_else(|| Scored::new(vec![0; rows.len()], rows, sizes.len(), scorer))
}

/// Robots by their share of a need, the largest first.
fn ranked_by_share(shares: &[Vec<f64>], need: usize) -> Vec<usize> {
    let mut ranked: Vec<usize> = (0..shares.len()).collect();
    ranked.sort_by(|a, b| shares[*b][need].total_cmp(&shares[*a][need]).then(a.cmp(b)));
    ranked
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rne::ScoreDirection;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn swaps_that_are_told_to_lose_change_no_answer() {
        let mut draws = ChaCha8Rng::seed_from_u64(5);
        let shapes: [&[usize]; 5] = [&[40, 41], &[20, 70], &[30, 30, 31], &[25, 25, 25, 25], &[3, 60]];
        for turn in 0..40 {
            let sizes = shapes[turn % shapes.len()];
            let (needs, least) = (2 + turn % 6, [0.5, 20.0][turn % 2]);
            let mut row = || (0..needs).map(|_| draws.random_range(least..40.0)).collect::<Vec<f64>>();
            let rows: Vec<Vec<f64>> = (0..sizes.iter().sum()).map(|_| row()).collect();
            let direction = [
                ScoreDirection::MaxOfBoth,
                ScoreDirection::FirstToSecond,
                ScoreDirection::Sum,
                ScoreDirection::JensenShannon,
            ][turn % 4];
            let [all, fewer] = [Spread::unknown(), Spread::of(&rows)]
                .map(|spread| search_with(spread, &rows, sizes, &mut Scorer::new(direction, false)));
            assert_eq!(all, fewer, "{direction:?}, {sizes:?}");
        }
    }
}
