//! The score of groups: Relative Needs Entropy between their distributions, by the direction of the options.

use super::options::ScoreDirection;
use rne_core::divergence::{jensen_shannon_nats, kullback_leibler};
use rne_core::needs::shares_into;

/// A later candidate wins only if it is better by more than this, in nats, so that rounding never decides a
/// tie.
pub(super) const TIE_TOLERANCE: f64 = 1e-12;

/// Scores groups given as sums of weighted needs. It reuses its memory from call to call.
pub(super) struct Scorer {
    pub(super) direction: ScoreDirection,
    pub(super) sort: bool,
    p: Vec<f64>,
    q: Vec<f64>,
}

impl Scorer {
    pub(super) fn new(direction: ScoreDirection, sort: bool) -> Self {
        Self { direction, sort, p: Vec::new(), q: Vec::new() }
    }

    /// RNE between two groups in nats; minus infinity if a group is empty and thus has no distribution.
    pub(super) fn score(&mut self, first: &[f64], second: &[f64]) -> f64 {
        if !self.normalise(first, second) {
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

    /// RNE from the first group to the second, whatever the direction of the scorer.
    pub(super) fn directed(&mut self, first: &[f64], second: &[f64]) -> f64 {
        if self.normalise(first, second) { kullback_leibler(&self.p, &self.q) } else { f64::NEG_INFINITY }
    }

    /// Sum of the scores of all pairs of these groups; minus infinity if fewer than two have members. The
    /// sums of a group begin at index `from` of its row.
    pub(super) fn total<G: AsRef<[f64]>>(&mut self, groups: &[G], from: usize) -> f64 {
        let mut total = f64::NEG_INFINITY;
        for (i, first) in groups.iter().enumerate() {
            for second in &groups[i + 1..] {
                total = add_pair(total, self.score(&first.as_ref()[from..], &second.as_ref()[from..]));
            }
        }
        total
    }

    /// Writes both distributions to the scratch space. Returns `false` if one of them does not exist.
    fn normalise(&mut self, first: &[f64], second: &[f64]) -> bool {
        let exists = shares_into(first, &mut self.p) > 0.0 && shares_into(second, &mut self.q) > 0.0;
        if exists && self.sort {
            self.p.sort_by(f64::total_cmp);
            self.q.sort_by(f64::total_cmp);
        }
        exists
    }
}

/// Adds the score of a pair to a sum of scores, which is minus infinity before the first score. A pair with
/// an empty group does not count.
pub(super) fn add_pair(total: f64, score: f64) -> f64 {
    if score == f64::NEG_INFINITY {
        total
    } else if total == f64::NEG_INFINITY {
        score
    } else {
        total + score
    }
}

/// Adds a row of weighted needs to a sum.
pub(super) fn add(sum: &mut [f64], row: &[f64]) {
    for (sum, need) in sum.iter_mut().zip(row) {
        *sum += need;
    }
}

/// The sums of weighted needs of each part.
pub(super) fn part_sums(rows: &[Vec<f64>], part_of: &[usize], parts: usize) -> Vec<Vec<f64>> {
    let mut sums = vec![vec![0.0; rows[0].len()]; parts];
    for (row, part) in rows.iter().zip(part_of) {
        add(&mut sums[*part], row);
    }
    sums
}
