//! The split of one role into two halves with the largest RNE between them (the paper's Algorithms 1, 2 and 3).
//!
//! Exact for up to [`EXACT_ROLE_SIZE`] robots: every unordered split is looked at once, with sums that grow along the branch, so
//! that no split allocates and no rounding depends on the way it was reached. Above that a deterministic local search.

use super::rne::ScoreDirection;
use crate::divergence::{jensen_shannon_nats, kullback_leibler};

/// Robots of one role up to which the split is searched exactly: 92,378 splits.
pub const EXACT_ROLE_SIZE: usize = 20;

/// A later candidate must be better by more than this, in nats, so that rounding never decides a tie.
pub(super) const TIE_TOLERANCE: f64 = 1e-12;

/// Bound on the scores computed by the local search of one role.
const LOCAL_SEARCH_SCORES: usize = 1_000_000;

/// Scores two groups, given as sums of weighted needs.
pub(super) struct Scorer {
    direction: ScoreDirection,
    sort: bool,
    p: Vec<f64>,
    q: Vec<f64>,
}

impl Scorer {
    pub(super) fn new(direction: ScoreDirection, sort: bool) -> Self {
        Self { direction, sort, p: Vec::new(), q: Vec::new() }
    }

    /// RNE between the groups in nats, by the scorer's direction; minus infinity where a group is empty and has no distribution.
    pub(super) fn score(&mut self, first: &[f64], second: &[f64]) -> f64 {
        if !(self.normalise(first, second)) {
            return f64::NEG_INFINITY;
        }
        let (p, q) = (&self.p, &self.q);
        match self.direction {
            ScoreDirection::MaxOfBoth => kullback_leibler(p, q).max(kullback_leibler(q, p)),
            ScoreDirection::FirstToSecond => kullback_leibler(p, q),
            ScoreDirection::Sum => kullback_leibler(p, q) + kullback_leibler(q, p),
            ScoreDirection::JensenShannon => jensen_shannon_nats(p, q),
        }
    }

    /// RNE from the first to the second, whatever the direction of the scorer.
    pub(super) fn directed(&mut self, first: &[f64], second: &[f64]) -> f64 {
        if self.normalise(first, second) { kullback_leibler(&self.p, &self.q) } else { f64::NEG_INFINITY }
    }

    /// Both distributions into the scratch space; `false` where one does not exist.
    fn normalise(&mut self, first: &[f64], second: &[f64]) -> bool {
        let exists = distribution_into(first, &mut self.p) && distribution_into(second, &mut self.q);
        if exists && self.sort {
            self.p.sort_by(f64::total_cmp);
            self.q.sort_by(f64::total_cmp);
        }
        exists
    }
}

fn distribution_into(sums: &[f64], shares: &mut Vec<f64>) -> bool {
    let total: f64 = sums.iter().sum();
    shares.clear();
    shares.extend(sums.iter().map(|sum| sum / total));
    total > 0.0
}

/// Two halves of a role as indices into its rows, ascending; the first half holds index 0.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Split {
    pub(super) first: Vec<usize>,
    pub(super) second: Vec<usize>,
    pub(super) proven_optimal: bool,
}

/// The best split of the robots whose weighted needs are `rows`. One robot, or none, goes into the first half.
pub(super) fn best_split(rows: &[Vec<f64>], scorer: &mut Scorer) -> Split {
    if rows.len() < 2 {
        return Split { first: (0..rows.len()).collect(), second: Vec::new(), proven_optimal: true };
    }
    let proven_optimal = rows.len() <= EXACT_ROLE_SIZE;
    let in_first = if proven_optimal { exact(rows, scorer) } else { local(rows, scorer) };
    let side = |wanted: bool| (0..rows.len()).filter(|i| (in_first[*i] == in_first[0]) == wanted).collect();
    Split { first: side(true), second: side(false), proven_optimal }
}

/// Depth-first over all unordered splits, in lexicographic order of the half with index 0.
struct ExactSearch<'a> {
    rows: &'a [Vec<f64>],
    scorer: &'a mut Scorer,
    /// Sums of either half at each depth, `(rows + 1) x needs`.
    sums: [Vec<f64>; 2],
    in_first: Vec<bool>,
    best: Vec<bool>,
    best_score: f64,
}

fn exact(rows: &[Vec<f64>], scorer: &mut Scorer) -> Vec<bool> {
    let depth_sums = vec![0.0; (rows.len() + 1) * rows[0].len()];
    let mut search = ExactSearch {
        rows,
        scorer,
        sums: [depth_sums.clone(), depth_sums],
        in_first: vec![false; rows.len()],
        best: vec![false; rows.len()],
        best_score: f64::NEG_INFINITY,
    };
    let (small, large) = (rows.len() / 2, rows.len() - rows.len() / 2);
    search.put(0, true, small - 1, large);
    if small != large {
        search.put(0, true, large - 1, small);
    }
    search.best
}

impl ExactSearch<'_> {
    /// Puts robot `at` into a half, with `first` and `second` places left after it, and goes on with the next robot.
    fn put(&mut self, at: usize, into_first: bool, first: usize, second: usize) {
        let needs = self.rows[at].len();
        for (half, grows) in self.sums.iter_mut().zip([into_first, !into_first]) {
            let (done, rest) = half.split_at_mut((at + 1) * needs);
            let before = &done[at * needs..];
            for ((sum, before), need) in rest.iter_mut().zip(before).zip(&self.rows[at]) {
                *sum = if grows { before + need } else { *before };
            }
        }
        self.in_first[at] = into_first;
        if first + second == 0 {
            return self.judge();
        }
        if first > 0 {
            self.put(at + 1, true, first - 1, second);
        }
        if second > 0 {
            self.put(at + 1, false, first, second - 1);
        }
    }

    fn judge(&mut self) {
        let end = self.sums[0].len() - self.rows[0].len();
        let score = self.scorer.score(&self.sums[0][end..], &self.sums[1][end..]);
        if score > self.best_score + TIE_TOLERANCE || self.best_score == f64::NEG_INFINITY {
            self.best_score = score;
            self.best.copy_from_slice(&self.in_first);
        }
    }
}

/// Starts from the best of the splits by rank in each need's share, then swaps pairs while that helps.
fn local(rows: &[Vec<f64>], scorer: &mut Scorer) -> Vec<bool> {
    let mut best = best_ranked_start(rows, scorer);
    let [mut first, mut second] = half_sums(rows, &best);
    let mut best_score = scorer.score(&first, &second);
    let mut left = LOCAL_SEARCH_SCORES;
    let (mut swapped_first, mut swapped_second) = (first.clone(), second.clone());
    loop {
        let mut improved = false;
        for i in 0..rows.len() {
            for j in i + 1..rows.len() {
                if best[i] == best[j] {
                    continue;
                }
                if left == 0 {
                    return best;
                }
                left -= 1;
                let (out, into) = if best[i] { (i, j) } else { (j, i) };
                for k in 0..first.len() {
                    swapped_first[k] = (first[k] - rows[out][k] + rows[into][k]).max(0.0);
                    swapped_second[k] = (second[k] - rows[into][k] + rows[out][k]).max(0.0);
                }
                if scorer.score(&swapped_first, &swapped_second) > best_score + TIE_TOLERANCE {
                    best.swap(i, j);
                    [first, second] = half_sums(rows, &best);
                    best_score = scorer.score(&first, &second);
                    improved = true;
                }
            }
        }
        if !improved {
            return best;
        }
    }
}

fn best_ranked_start(rows: &[Vec<f64>], scorer: &mut Scorer) -> Vec<bool> {
    let shares: Vec<Vec<f64>> = rows
        .iter()
        .map(|row| {
            let total: f64 = row.iter().sum();
            row.iter().map(|need| need / total).collect()
        })
        .collect();
    let sizes = [rows.len() / 2, rows.len() - rows.len() / 2];
    let mut best = (f64::NEG_INFINITY, Vec::new());
    for need in 0..rows[0].len() {
        let ranked = ranked_by_share(&shares, need);
        for size in sizes {
            let mut in_first = vec![false; rows.len()];
            ranked[..size].iter().for_each(|i| in_first[*i] = true);
            let [first, second] = half_sums(rows, &in_first);
            let score = scorer.score(&first, &second);
            if best.1.is_empty() || score > best.0 + TIE_TOLERANCE {
                best = (score, in_first);
            }
        }
    }
    best.1
}

/// Robots by their share of a need, the largest first.
fn ranked_by_share(shares: &[Vec<f64>], need: usize) -> Vec<usize> {
    let mut ranked: Vec<usize> = (0..shares.len()).collect();
    ranked.sort_by(|a, b| shares[*b][need].total_cmp(&shares[*a][need]).then(a.cmp(b)));
    ranked
}

fn half_sums(rows: &[Vec<f64>], in_first: &[bool]) -> [Vec<f64>; 2] {
    let mut sums = [vec![0.0; rows[0].len()], vec![0.0; rows[0].len()]];
    for (row, first) in rows.iter().zip(in_first) {
        add(&mut sums[usize::from(!first)], row);
    }
    sums
}

/// Adds a row of weighted needs to a sum.
pub(super) fn add(sum: &mut [f64], row: &[f64]) {
    for (sum, need) in sum.iter_mut().zip(row) {
        *sum += need;
    }
}
