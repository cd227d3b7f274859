//! Rank correlation.

use statrs::statistics::{Data, OrderStatistics, RankTieBreaker, Statistics};

/// Spearman's rank correlation: Pearson's correlation of the ranks, with ties at their mean rank. `None` if
/// one of the two lists does not vary.
///
/// # Panics
/// Never, if both lists have the same length.
pub fn rank_correlation(a: &[f64], b: &[f64]) -> Option<f64> {
    let ranks = |values: &[f64]| Data::new(values.to_vec()).ranks(RankTieBreaker::Average);
    let (a, b) = (ranks(a), ranks(b));
    let spread = a.clone().population_std_dev() * b.clone().population_std_dev();
    (a.len() > 1 && spread > 0.0).then(|| (a.population_covariance(b) / spread).clamp(-1.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_scipys() {
        // scipy.stats.spearmanr([1, 2, 3, 4, 5], [5, 6, 7, 8, 7]).statistic
        let found = rank_correlation(&[1.0, 2.0, 3.0, 4.0, 5.0], &[5.0, 6.0, 7.0, 8.0, 7.0]).unwrap();
        assert!((found - 0.820_782_681_668_123_3).abs() < 1e-12, "{found}");
        let reversed = rank_correlation(&[1.0, 2.0, 9.0], &[3.0, 2.0, -5.0]).unwrap();
        assert!((reversed + 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_does_not_vary_correlates_with_nothing() {
        assert_eq!(rank_correlation(&[1.0, 1.0, 1.0], &[1.0, 2.0, 3.0]), None);
        assert_eq!(rank_correlation(&[], &[]), None);
    }
}
