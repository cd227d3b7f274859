//! Smaller parts of a paired comparison: shift, correction for many tests, and what a number of pairs can
//! detect.

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

use super::Moments;
use super::bootstrap::quantile;

/// Largest number of differences for which the means of all pairs are listed. Beyond it, their median is
/// found by bisection.
const LISTED: usize = 1_000;

/// Hodges-Lehmann shift: the median of the means of all pairs of differences, including each difference
/// with itself (Hodges & Lehmann 1963). `None` without differences.
pub fn hodges_lehmann(differences: &[f64]) -> Option<f64> {
    if differences.len() > LISTED {
        return Some(closed_in(differences));
    }
    let mut averages: Vec<f64> = differences
        .iter()
        .enumerate()
        .flat_map(|(i, a)| differences[i..].iter().map(move |b| f64::midpoint(*a, *b)))
        .collect();
    averages.sort_by(f64::total_cmp);
    (!averages.is_empty()).then(|| quantile(&averages, 0.5))
}

/// The lower median of the means of all pairs, by bisection of its range. Each step counts the lower means
/// in one pass.
fn closed_in(differences: &[f64]) -> f64 {
    let mut sorted = differences.to_vec();
    sorted.sort_by(f64::total_cmp);
    let count = sorted.len();
    let up_to = |limit: f64| {
        let (mut pairs, mut above) = (0, count);
        for (i, a) in sorted.iter().enumerate() {
            while above > 0 && f64::midpoint(*a, sorted[above - 1]) > limit {
                above -= 1;
            }
            pairs += above.saturating_sub(i);
        }
        pairs
    };
    let wanted = (count * (count + 1) / 2).div_ceil(2);
    let (mut low, mut high) = (sorted[0], sorted[count - 1]);
    loop {
        let middle = f64::midpoint(low, high);
        if middle <= low || middle >= high {
            return if up_to(low) >= wanted { low } else { high };
        }
        if up_to(middle) >= wanted { high = middle } else { low = middle }
    }
}

/// Holm's correction (1979) of the p values of a family, in the given order. It keeps the probability of
/// any false finding below the level.
pub fn holm(ps: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..ps.len()).collect();
    order.sort_by(|a, b| ps[*a].total_cmp(&ps[*b]));
    let mut corrected = vec![0.0; ps.len()];
    let mut least: f64 = 0.0;
    for (rank, place) in order.into_iter().enumerate() {
        least = least.max(ps[place] * (ps.len() - rank) as f64).min(1.0);
        corrected[place] = least;
    }
    corrected
}

/// Number of pairs that a two-sided paired t test at 5 % needs for 80 % power, if the true effect is the
/// observed one: Guenther's approximation to the noncentral t (1981). `None` if the observed mean or
/// standard deviation is zero.
pub fn pairs_needed(differences: &[f64]) -> Option<u64> {
    let Moments { mean, sd, .. } = Moments::of(differences);
    let effect = (mean? / sd.filter(|sd| *sd > 0.0)?).abs();
    let normal = Normal::standard();
    let (level, power) = (normal.inverse_cdf(0.975), normal.inverse_cdf(0.8));
    let pairs = ((level + power) / effect).powi(2) + level * level / 2.0;
    (pairs.is_finite() && pairs < 1e12).then(|| (pairs.ceil() as u64).max(2))
}

/// The least number of distinct pairs that give an interval, a p value and a verdict: with fewer, no p of
/// Wilcoxon's signed-rank test is below 0.05.
pub const LEAST_PAIRS: usize = 6;

/// The least true mean difference that a two-sided paired t test at 5 % with this many pairs detects with
/// 80 % power, if the differences have this standard deviation (Guenther's approximation to the noncentral
/// t, 1981, solved for the difference). It depends on the standard deviation of the differences, not on
/// their mean. `None` for fewer than [`LEAST_PAIRS`], or without any spread.
pub fn detectable(sd: f64, pairs: usize) -> Option<f64> {
    let normal = Normal::standard();
    let (level, power) = (normal.inverse_cdf(0.975), normal.inverse_cdf(0.8));
    let is_told = pairs >= LEAST_PAIRS && sd > 0.0;
    is_told.then(|| (level + power) * sd / (pairs as f64 - level * level / 2.0).sqrt())
}

/// Number of pairs with which a true difference as large as the margin is detected with 80 % power by a
/// two-sided paired t test at 5 %, and equal policies are shown to be equivalent with 80 % power by two
/// one-sided tests at 5 %. A true difference near the margin may stay undecided, whatever the number. It
/// depends on the standard deviation of the differences, not on their mean. `None` without any spread.
pub fn pairs_for_margin(differences: &[f64], margin: f64) -> Option<u64> {
    let sd = Moments::of(differences).sd.filter(|sd| *sd > 0.0)?;
    let normal = Normal::standard();
    // Guenther's approximation (1981), with the level's and the power's quantiles of each test.
    let pairs = |level: f64, power: f64| {
        let (level, power) = (normal.inverse_cdf(level), normal.inverse_cdf(power));
        ((level + power) * sd / margin).powi(2) + level * level / 2.0
    };
    let most = pairs(0.975, 0.8).max(pairs(0.95, 0.9));
    (most.is_finite() && most < 1e12).then(|| (most.ceil() as u64).max(LEAST_PAIRS as u64))
}

/// Half the width of the 95 % paired t interval; `None` for fewer than two differences.
pub fn t_half_width(differences: &[f64]) -> Option<f64> {
    t_half_width_at(differences, 0.95)
}

/// The same as [`t_half_width`], at another confidence.
pub fn t_half_width_at(differences: &[f64], confidence: f64) -> Option<f64> {
    let count = differences.len() as f64;
    let sd = Moments::of(differences).sd?;
    let t = StudentsT::new(0.0, 1.0, count - 1.0).ok()?.inverse_cdf(f64::midpoint(1.0, confidence));
    Some(t * sd / count.sqrt())
}
