//! Wilcoxon's signed-rank test of paired differences, exact with ties and zeros.
//!
//! Differences are rounded to a billionth of the largest before they are ranked, so that what is tied on
//! paper is tied. Zeros are left out (Wilcoxon 1945), and tied magnitudes share their mean rank. The sum of
//! the ranks of positive differences is compared with its distribution over all 2^n choices of signs. Up to
//! [`EXACT_PAIRS`] differences, this distribution is counted exactly by adding one difference after the
//! other. Up to [`DRAWN_PAIRS`], [`DRAWS`] random choices of signs replace it. Beyond that, the normal
//! distribution with the same mean and variance replaces it, with ties and a continuity correction; it is
//! then indistinguishable from the exact one. Checked against `SciPy` 1.17.1, `wilcoxon(d,
//! method=PermutationMethod(n_resamples=numpy.inf))`.

use rand::rngs::ChaCha8Rng;
use rand::{Rng, SeedableRng};
use statrs::distribution::{ContinuousCDF, Normal};

/// Largest number of nonzero differences for which all choices of signs are counted.
pub const EXACT_PAIRS: usize = 500;
/// Number of random choices of signs for more differences.
pub const DRAWS: u32 = 100_000;
/// Largest number of nonzero differences for which signs are drawn.
pub const DRAWN_PAIRS: usize = 10_000;

/// The result of the test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SignedRank {
    /// Number of nonzero differences.
    pub pairs: usize,
    /// Sum of the ranks of positive differences.
    pub positive: f64,
    /// Sum of the ranks of negative differences.
    pub negative: f64,
    /// Two-sided p; 1 without any difference.
    pub p: f64,
    /// Whether p was counted over all choices of signs.
    pub is_exact: bool,
}

impl SignedRank {
    /// The test of these differences, which must be finite.
    pub fn of(differences: &[f64]) -> Self {
        let mut nonzero: Vec<f64> = rounded(differences).filter(|d| *d != 0.0).collect();
        nonzero.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
        let ranks = doubled_ranks(&nonzero);
        let sum = |is_positive: bool| -> u64 {
            let signed = nonzero.iter().zip(&ranks).filter(|(d, _)| (**d > 0.0) == is_positive);
            signed.map(|(_, rank)| rank).sum()
        };
        let (positive, negative) = (sum(true), sum(false));
        let is_exact = ranks.len() <= EXACT_PAIRS;
        let larger = positive.max(negative);
        let tail = match ranks.len() {
            0..=EXACT_PAIRS => counted_tail(&ranks, larger),
            count if count <= DRAWN_PAIRS => drawn_tail(&ranks, larger),
            _ => normal_tail(&ranks, larger),
        };
        Self {
            pairs: ranks.len(),
            positive: positive as f64 / 2.0,
            negative: negative as f64 / 2.0,
            p: (2.0 * tail).min(1.0),
            is_exact,
        }
    }

    /// Matched-pairs rank-biserial correlation, from -1 to 1: the share of the rank sum of positive
    /// differences minus the share of negative ones (Kerby 2014). 0 without any difference.
    pub fn effect(&self) -> f64 {
        let total = self.positive + self.negative;
        if total > 0.0 { (self.positive - self.negative) / total } else { 0.0 }
    }
}

/// The differences in billionths of the largest: differences that are tied on paper, as 5.34 - 3.20 and
/// 2.14 - 0.00 are, are not tied in binary without it.
fn rounded(differences: &[f64]) -> impl Iterator<Item = f64> + '_ {
    let largest = differences.iter().fold(0.0, |most: f64, d| most.max(d.abs()));
    let unit = if largest > 0.0 { largest * 1e-9 } else { 1.0 };
    differences.iter().map(move |d| (d / unit).round())
}

/// Twice the mean ranks of sorted magnitudes; doubled, they are whole numbers.
fn doubled_ranks(sorted: &[f64]) -> Vec<u64> {
    let mut ranks = Vec::with_capacity(sorted.len());
    for tied in sorted.chunk_by(|a, b| a.abs().total_cmp(&b.abs()).is_eq()) {
        let first = ranks.len() as u64 + 1;
        let last = ranks.len() + tied.len();
        ranks.resize(last, first + last as u64);
    }
    ranks
}

/// Probability that the rank sum of random signs is at least `least`.
fn counted_tail(ranks: &[u64], least: u64) -> f64 {
    let total: u64 = ranks.iter().sum();
    let mut chances = vec![0.0; total as usize + 1];
    chances[0] = 1.0;
    let mut reached = 0;
    for rank in ranks {
        let rank = *rank as usize;
        for sum in (0..=reached).rev() {
            let half = chances[sum] / 2.0;
            chances[sum] = half;
            chances[sum + rank] += half;
        }
        reached += rank;
    }
    chances[least as usize..].iter().sum()
}

/// The same probability from random signs. The observed signs count as one of the draws, so that it is
/// never 0.
fn drawn_tail(ranks: &[u64], least: u64) -> f64 {
    let mut draws = ChaCha8Rng::seed_from_u64(0);
    let mut as_extreme = 1_u32;
    for _ in 0..DRAWS {
        let sum: u64 = ranks
            .chunks(64)
            .map(|chunk| {
                let signs = draws.next_u64();
                chunk.iter().enumerate().map(|(i, rank)| rank * ((signs >> i) & 1)).sum::<u64>()
            })
            .sum();
        as_extreme += u32::from(sum >= least);
    }
    f64::from(as_extreme) / f64::from(DRAWS + 1)
}

/// The same probability from the normal distribution with the sum's mean and variance, with a continuity
/// correction of half a rank.
fn normal_tail(ranks: &[u64], least: u64) -> f64 {
    let mean = ranks.iter().sum::<u64>() as f64 / 2.0;
    let variance = ranks.iter().map(|rank| (*rank as f64).powi(2)).sum::<f64>() / 4.0;
    let z = (least as f64 - mean - 1.0).max(0.0) / variance.sqrt();
    Normal::standard().cdf(-z).max(f64::MIN_POSITIVE)
}
