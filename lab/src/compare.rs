//! Compares two policies over pairs of trials, as `usar compare` does.

use serde::Deserialize;
use statistics::comparison::{Comparison, Direction, Pairs, Repeats, correct};

use crate::Failure;

/// Pairs of trials in one metric, of which more is better.
#[derive(Deserialize)]
pub(crate) struct Asked {
    /// Name of the metric.
    metric: String,
    /// The first policy.
    a: String,
    /// The second policy.
    b: String,
    /// For each seed, the value and the state hash of the first policy's trial, and of the second's.
    pairs: Vec<Pair>,
}

/// Values of both trials, then their state hashes.
type Pair = (f64, f64, String, String);

/// The comparison of the pairs, alone in its family.
pub(crate) fn compare(asked: Asked) -> Result<Comparison, Failure> {
    let (mut pairs, mut repeats) = (Pairs::default(), Repeats::default());
    for (trial, (a, b, hash_a, hash_b)) in (1..).zip(&asked.pairs) {
        let hash = |text: &str| u128::from_str_radix(text, 16);
        let hashes = [hash(hash_a), hash(hash_b)].map(|hash| hash.unwrap_or(0));
        if !(a.is_finite() && b.is_finite()) {
            return Err(Failure::of(format!("pair {trial} has a value that is not finite")));
        }
        if repeats.is_new(trial, &hashes) {
            pairs.a.push(*a);
            pairs.b.push(*b);
        } else {
            pairs.repeated += 1;
        }
    }
    let Asked { metric, a, b, .. } = asked;
    let mut comparison = Comparison { case: 1, metric, a, b, ..Comparison::default() }.measured(&pairs);
    correct(std::slice::from_mut(&mut comparison));
    comparison.judge(Direction::Higher, None);
    Ok(comparison)
}
