//! The regularised incomplete beta function: how likely a Beta distribution is below a value.

/// Parts of the continued fraction at most. It takes about the square root of the larger parameter.
const MOST_PARTS: u32 = 10_000;

/// The fraction has converged when a part changes it by no more than this share.
const CLOSE: f64 = 1e-15;

/// Stands for a divisor of zero.
const TINY: f64 = 1e-300;

/// The probability that a Beta distribution with these parameters is at most `x`. Both parameters must be
/// above 0. Source: the continued fraction of Abramowitz and Stegun, Handbook of Mathematical Functions,
/// 26.5.8, by the method of Lentz, with the mirrored function beyond the mean.
pub(super) fn below(x: f64, [a, b]: [f64; 2]) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    if x > (a + 1.0) / (a + b + 2.0) { 1.0 - part(1.0 - x, b, a) } else { part(x, a, b) }
}

/// The probability that it is between two values.
pub(super) fn within(from: f64, to: f64, parameters: [f64; 2]) -> f64 {
    (below(to, parameters) - below(from, parameters)).clamp(0.0, 1.0)
}

fn part(x: f64, a: f64, b: f64) -> f64 {
    let log =
        libm::lgamma(a + b) - libm::lgamma(a) - libm::lgamma(b) + a * libm::log(x) + b * libm::log1p(-x);
    (libm::exp(log) / (a * fraction(x, a, b))).clamp(0.0, 1.0)
}

/// The continued fraction `1 + d1 / (1 + d2 / (1 + ...))`.
#[expect(clippy::many_single_char_names, reason = "the names of the formula")]
fn fraction(x: f64, a: f64, b: f64) -> f64 {
    let nonzero = |value: f64| if value.abs() < TINY { TINY } else { value };
    let (mut value, mut c, mut d) = (1.0, 1.0, 0.0);
    for i in 1..=MOST_PARTS {
        let m = f64::from(i / 2);
        let term = if i % 2 == 0 {
            m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m))
        } else {
            -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))
        };
        d = 1.0 / nonzero(1.0 + term * d);
        c = nonzero(1.0 + term / c);
        let change = c * d;
        value *= change;
        if (change - 1.0).abs() <= CLOSE {
            break;
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Closed forms: `I_x(1, 1) = x`, `I_x(a, 1) = x^a`, `I_x(2, 2) = x^2 (3 - 2 x)`, and `I_x(a, b)` of
    /// whole numbers as a sum of binomial terms.
    #[test]
    fn the_function_has_its_closed_forms() {
        for x in [0.0, 0.01, 0.3, 0.5, 0.77, 0.999, 1.0] {
            assert!((below(x, [1.0, 1.0]) - x).abs() < 1e-14);
            assert!((below(x, [3.5, 1.0]) - libm::pow(x, 3.5)).abs() < 1e-14);
            assert!((below(x, [2.0, 2.0]) - x * x * (3.0 - 2.0 * x)).abs() < 1e-14);
        }
        let binomial = |x: f64, a: i32, b: i32| -> f64 {
            let n = a + b - 1;
            let choose = |k: i32| (1..=k).fold(1.0, |all, i| all * f64::from(n - k + i) / f64::from(i));
            (a..=n).map(|k| choose(k) * x.powi(k) * (1.0 - x).powi(n - k)).sum()
        };
        for (x, a, b) in [(0.2, 12, 5), (0.4, 12, 5), (0.95, 11, 2), (0.05, 2, 11)] {
            let (found, sum) = (below(x, [f64::from(a), f64::from(b)]), binomial(x, a, b));
            assert!((found / sum - 1.0).abs() < 1e-12, "{x} {a} {b}: {found} {sum}");
        }
        assert!((below(0.5, [5000.0, 5000.0]) - 0.5).abs() < 1e-9);
        assert!((within(0.2, 0.4, [1.0, 1.0]) - 0.2).abs() < 1e-14);
    }
}
