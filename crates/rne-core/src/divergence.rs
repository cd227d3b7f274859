//! Relative entropy between distributions, its symmetric relatives, and mutual information (paper: Eqs. 1, 2
//! and 7).
//!
//! Checked against `SciPy` 1.17 (`scipy.stats.entropy`, `scipy.spatial.distance.jensenshannon` squared). All
//! in nats.

use crate::error::NeedsError;
use crate::needs::{NeedDistribution, check_entries, check_length};
use crate::trust::RelativeNeedsEntropy;

/// `T(P||Q) = sum_k P_k ln(P_k / Q_k)` (Eqs. 1 and 7), the RNE from the holder of `p` to the holder of `q`.
/// `0 ln(0/q)` is 0; a need with `p > 0` and `q = 0` makes the value infinite.
///
/// # Errors
/// Distributions over different numbers of needs.
pub fn relative_entropy(
    p: &NeedDistribution,
    q: &NeedDistribution,
) -> Result<RelativeNeedsEntropy, NeedsError> {
    check_length("second distribution", p.shares().len(), q.shares().len())?;
    Ok(RelativeNeedsEntropy::from_nats(kullback_leibler(p.shares(), q.shares())))
}

/// The contribution of each need to `T(P||Q)`, in nats: the summands of Eqs. 1 and 7. They add up to the
/// relative entropy. A need with a smaller share in `p` than in `q` contributes a negative number. `None` for
/// the needs that make the value infinite.
///
/// ```
/// use rne_core::{NeedDistribution, relative_entropy_by_need};
///
/// let p = NeedDistribution::from_shares(vec![0.5, 0.5])?;
/// let q = NeedDistribution::from_shares(vec![0.25, 0.75])?;
/// let by_need = relative_entropy_by_need(&p, &q)?;
/// assert!(by_need[0].unwrap() > 0.0 && by_need[1].unwrap() < 0.0);
/// # Ok::<(), rne_core::NeedsError>(())
/// ```
///
/// # Errors
/// Distributions over different numbers of needs.
pub fn relative_entropy_by_need(
    p: &NeedDistribution,
    q: &NeedDistribution,
) -> Result<Vec<Option<f64>>, NeedsError> {
    check_length("second distribution", p.shares().len(), q.shares().len())?;
    Ok(p.shares().iter().zip(q.shares()).map(|(p, q)| summand(*p, *q)).collect())
}

/// `T(P||Q) + T(Q||P)` (Jeffreys).
///
/// # Errors
/// Distributions over different numbers of needs.
pub fn jeffreys(p: &NeedDistribution, q: &NeedDistribution) -> Result<RelativeNeedsEntropy, NeedsError> {
    check_length("second distribution", p.shares().len(), q.shares().len())?;
    let both = kullback_leibler(p.shares(), q.shares()) + kullback_leibler(q.shares(), p.shares());
    Ok(RelativeNeedsEntropy::from_nats(both))
}

/// Jensen-Shannon divergence: the mean relative entropy to the midpoint of the two; in [0, ln 2], never
/// infinite.
///
/// # Errors
/// Distributions over different numbers of needs.
pub fn jensen_shannon(p: &NeedDistribution, q: &NeedDistribution) -> Result<f64, NeedsError> {
    check_length("second distribution", p.shares().len(), q.shares().len())?;
    Ok(jensen_shannon_nats(p.shares(), q.shares()))
}

/// Mutual information `I(X;Y)` of a joint distribution, in nats: the relative entropy between the joint and
/// the product of its margins (Eq. 2). Each row holds the probabilities of one `x` with every `y`.
///
/// # Errors
/// No entries; an entry that is NaN, infinite or negative; rows of different lengths; or entries that do not
/// add up to 1 (to within 1e-9).
pub fn mutual_information(joint: &[Vec<f64>]) -> Result<f64, NeedsError> {
    let what = "joint distribution";
    let length = joint.first().map_or(0, Vec::len);
    joint.iter().try_for_each(|row| check_length("row of the joint distribution", length, row.len()))?;
    check_entries(what, &joint.concat())?;
    let rows: Vec<f64> = joint.iter().map(|row| row.iter().sum()).collect();
    let columns: Vec<f64> = (0..length).map(|y| joint.iter().map(|row| row[y]).sum()).collect();
    let sum: f64 = rows.iter().sum();
    if (sum - 1.0).abs() > 1e-9 {
        return Err(NeedsError::NotNormalised { what, found: sum });
    }
    let mut information = 0.0;
    for (row, x) in joint.iter().zip(&rows) {
        for (p, y) in row.iter().zip(&columns).filter(|(p, _)| **p > 0.0) {
            // As a difference of logarithms: the product of two small margins could vanish, their
            // logarithms cannot.
            information += p * (libm::log(*p) - libm::log(*x) - libm::log(*y));
        }
    }
    Ok(information.max(0.0))
}

/// Kullback-Leibler sum over raw shares; `f64::INFINITY` if a need has a share in `p` but none in `q`.
#[must_use]
#[inline]
pub fn kullback_leibler(p: &[f64], q: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (p, q) in p.iter().zip(q) {
        match summand(*p, *q) {
            Some(summand) => sum += summand,
            None => return f64::INFINITY,
        }
    }
    sum
}

/// The summand `p ln(p / q)`; 0 if `p` is 0, and `None` if it is infinite.
#[inline]
fn summand(p: f64, q: f64) -> Option<f64> {
    if p <= 0.0 {
        return Some(0.0);
    }
    (q > 0.0).then(|| p * log_ratio(p, q))
}

/// `ln(p / q)` for shares above zero, also where the quotient leaves the range of `f64`.
#[inline]
fn log_ratio(p: f64, q: f64) -> f64 {
    let ratio = p / q;
    if ratio.is_normal() { libm::log(ratio) } else { libm::log(p) - libm::log(q) }
}

/// Jensen-Shannon sum over raw shares.
#[must_use]
#[inline]
pub fn jensen_shannon_nats(p: &[f64], q: &[f64]) -> f64 {
    let half = |a: f64, b: f64| if a > 0.0 { a * libm::log(a / f64::midpoint(a, b)) } else { 0.0 };
    let sum: f64 = p.iter().zip(q).map(|(p, q)| 0.5 * (half(*p, *q) + half(*q, *p))).sum();
    sum.max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shares(values: &[f64]) -> NeedDistribution {
        NeedDistribution::from_shares(values.to_vec()).unwrap()
    }

    #[test]
    fn a_need_that_the_other_lacks_is_an_explicit_infinity() {
        let (p, q) = (shares(&[0.5, 0.5]), shares(&[1.0, 0.0]));
        assert!(relative_entropy(&p, &q).unwrap().is_infinite());
        let finite = relative_entropy(&q, &p).unwrap().nats().unwrap();
        assert!((finite - std::f64::consts::LN_2).abs() < 1e-15);
    }

    #[test]
    fn symmetric_divergences_match_scipy() {
        // scipy.stats.entropy([.2,.3,.5],[.5,.25,.25]) + the reverse; jensenshannon(...)**2
        let (p, q) = (shares(&[0.2, 0.3, 0.5]), shares(&[0.5, 0.25, 0.25]));
        assert!((jeffreys(&p, &q).unwrap().nats().unwrap() - 0.457_290_092_541_930_5).abs() < 1e-12);
        assert!((jensen_shannon(&p, &q).unwrap() - 0.055_582_470_863_469_35).abs() < 1e-12);
    }

    #[test]
    fn mutual_information_is_zero_for_independent_and_ln_2_for_equal_coins() {
        let of =
            |rows: &[&[f64]]| mutual_information(&rows.iter().map(|row| row.to_vec()).collect::<Vec<_>>());
        assert!(of(&[&[0.25, 0.25], &[0.25, 0.25]]).unwrap().abs() < 1e-15);
        let coins = of(&[&[0.5, 0.0], &[0.0, 0.5]]).unwrap();
        assert!((coins - std::f64::consts::LN_2).abs() < 1e-15);
        let wrong: [&[&[f64]]; 4] = [&[], &[&[0.5, 0.6]], &[&[0.5], &[0.25, 0.25]], &[&[1.5, -0.5]]];
        for wrong in wrong {
            assert!(of(wrong).is_err(), "{wrong:?}");
        }
    }

    #[test]
    fn the_needs_add_up_to_the_relative_entropy() {
        let (p, q) = (shares(&[0.2, 0.3, 0.5]), shares(&[0.5, 0.25, 0.25]));
        let by_need = relative_entropy_by_need(&p, &q).unwrap();
        let sum: f64 = by_need.iter().map(|summand| summand.unwrap()).sum();
        assert_eq!(Some(sum), relative_entropy(&p, &q).unwrap().nats());
        // 0.2 ln 0.4
        assert!((by_need[0].unwrap() + 0.183_258_146_374_831_03).abs() < 1e-15);
        let lacking = relative_entropy_by_need(&shares(&[0.5, 0.5]), &shares(&[1.0, 0.0])).unwrap();
        assert_eq!(lacking[1], None);
    }

    #[test]
    fn shares_at_the_edge_of_the_number_range_give_a_finite_value() {
        let p = shares(&[1.0 - 1e-300, 1e-300]);
        let q = shares(&[1e-320, 1.0 - 1e-320]);
        assert!(relative_entropy(&p, &q).unwrap().nats().unwrap().is_finite());
    }
}
