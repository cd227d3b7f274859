//! Intervals of shares.

use statrs::distribution::{Beta, ContinuousCDF};

/// The exact interval of a share (Clopper and Pearson 1934); `None` without any trial.
pub fn clopper_pearson(held: usize, n: usize, confidence: f64) -> Option<[f64; 2]> {
    let tail = (1.0 - confidence) / 2.0;
    let (k, n) = (held as f64, n as f64);
    if n == 0.0 {
        return None;
    }
    let quantile = |a: f64, b: f64, p: f64| Some(Beta::new(a, b).ok()?.inverse_cdf(p));
    let low = if held == 0 { 0.0 } else { quantile(k, n - k + 1.0, tail)? };
    let high = if k >= n { 1.0 } else { quantile(k + 1.0, n - k, 1.0 - tail)? };
    Some([low, high])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `scipy.stats.binomtest(45, 50).proportion_ci(0.95, "exact")`
    #[test]
    fn the_interval_of_a_share_is_scipys() {
        let [low, high] = clopper_pearson(45, 50, 0.95).unwrap();
        assert!((low - 0.781_863_9).abs() < 1e-6 && (high - 0.966_724_6).abs() < 1e-6, "{low} {high}");
        assert_eq!(clopper_pearson(0, 0, 0.95), None);
        assert!(clopper_pearson(5, 5, 0.95).unwrap()[1] >= 1.0);
    }
}
