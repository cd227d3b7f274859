//! Partitions of roles that are too large for the exact search: a deterministic local search.
//!
//! The search starts from the best partition by rank in one need's share, then swaps pairs of robots as long
//! as a swap improves the score. The result is not proven optimal; an upper bound limits its distance from
//! the optimum.

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
    let mut best = best_ranked_start(rows, sizes, scorer);
    let mut searched = 0;
    while searched < MAX_SWAPS && improve(&mut best, rows, scorer, &mut searched) {}
    let pairs = (sizes.len() * (sizes.len() - 1) / 2) as f64;
    Partition {
        parts: in_order(&best.part_of, sizes.len()),
        runner_up: None,
        searched,
        proven_optimal: false,
        upper_bound: scorer.bound(rows).map(|bound| pairs * bound),
    }
}

/// Tries to swap each pair of robots once, and keeps each swap that improves the score. Returns whether any
/// did, but false once [`MAX_SWAPS`] is reached.
fn improve(best: &mut Scored, rows: &[Vec<f64>], scorer: &mut Scorer, searched: &mut u64) -> bool {
    let parts = best.sums.len();
    let mut swapped = [best.sums[0].clone(), best.sums[0].clone()];
    let mut improved = false;
    for i in 0..rows.len() {
        for j in i + 1..rows.len() {
            if best.part_of[i] == best.part_of[j] {
                continue;
            }
            if *searched == MAX_SWAPS {
                return false;
            }
            *searched += 1;
            let (out, into) = if best.part_of[i] < best.part_of[j] { (i, j) } else { (j, i) };
            let [low, high] = [best.part_of[out], best.part_of[into]];
            for k in 0..rows[0].len() {
                swapped[0][k] = (best.sums[low][k] - rows[out][k] + rows[into][k]).max(0.0);
                swapped[1][k] = (best.sums[high][k] - rows[into][k] + rows[out][k]).max(0.0);
            }
            let total =
                best.total_with(&Swap { parts: [low, high], sums: [&swapped[0], &swapped[1]] }, scorer);
            if total > best.total + TIE_TOLERANCE {
                let mut part_of = std::mem::take(&mut best.part_of);
                part_of.swap(i, j);
                *best = Scored::new(part_of, rows, parts, scorer);
                improved = true;
            }
        }
    }
    improved
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
