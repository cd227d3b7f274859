//! The value of trust: Relative Needs Entropy with an explicit infinity, its logarithm's base, and trust as a
//! share.

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};

/// Relative Needs Entropy of one robot or group towards another, in nats. Lower means more trust; it is not
/// symmetric.
///
/// Users should know two properties. RNE is blind to magnitude: proportional needs give 0, so that a nearly
/// dead robot and a fresh one can trust each other fully. And between robots of one type whose speed and
/// ranges scale with HP it sees little but the ratio of energy to HP.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum RelativeNeedsEntropy {
    /// A finite value >= 0, in nats.
    Finite(f64),
    /// A need that one side has and the other lacks altogether (`p > 0, q = 0`).
    Infinite,
}

impl RelativeNeedsEntropy {
    /// Wraps a value in nats; `f64::INFINITY` becomes [`RelativeNeedsEntropy::Infinite`].
    ///
    /// Relative entropy is never negative; the tiny negative values that rounding can produce are returned as
    /// 0.
    #[must_use]
    #[inline]
    pub fn from_nats(nats: f64) -> Self {
        debug_assert!(!nats.is_nan());
        if nats == f64::INFINITY { Self::Infinite } else { Self::Finite(nats.max(0.0)) }
    }

    /// The value in nats, or `None` where it is infinite.
    #[must_use]
    pub fn nats(self) -> Option<f64> {
        self.in_base(LogBase::E)
    }

    /// The value with another logarithm, or `None` where it is infinite.
    #[must_use]
    pub fn in_base(self, base: LogBase) -> Option<f64> {
        match self {
            Self::Finite(nats) => Some(nats / base.nats_per_unit()),
            Self::Infinite => None,
        }
    }

    /// Whether a need is lacking altogether on one side.
    #[must_use]
    pub fn is_infinite(self) -> bool {
        self == Self::Infinite
    }

    /// Trust as a share in [0, 1]: `exp(-T)`, with 1 for equal distributions and 0 for an infinite value.
    #[must_use]
    pub fn trust(self) -> f64 {
        match self {
            Self::Finite(nats) => libm::exp(-nats),
            Self::Infinite => 0.0,
        }
    }
}

impl PartialOrd for RelativeNeedsEntropy {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match (self, other) {
            (Self::Finite(a), Self::Finite(b)) => a.partial_cmp(b),
            (Self::Infinite, Self::Infinite) => Some(Ordering::Equal),
            (Self::Finite(_), Self::Infinite) => Some(Ordering::Less),
            (Self::Infinite, Self::Finite(_)) => Some(Ordering::Greater),
        }
    }
}

/// Base of the logarithm in which an RNE value is printed. It scales the value and changes no decision.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum LogBase {
    /// Natural logarithm: nats. The default; the paper's Examples 1 and 2.
    #[default]
    E,
    /// Base 2: bits.
    Two,
    /// Base 10: bans. The paper's Example 3.
    Ten,
}

impl LogBase {
    fn nats_per_unit(self) -> f64 {
        match self {
            Self::E => 1.0,
            Self::Two => std::f64::consts::LN_2,
            Self::Ten => std::f64::consts::LN_10,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn infinity_is_above_every_number_and_means_no_trust() {
        assert!(RelativeNeedsEntropy::Infinite > RelativeNeedsEntropy::Finite(f64::MAX));
        assert!(RelativeNeedsEntropy::Infinite.trust() == 0.0);
        assert_eq!(RelativeNeedsEntropy::Infinite.nats(), None);
        assert!((RelativeNeedsEntropy::Finite(0.0).trust() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn bases_scale_the_value() {
        let one_bit = RelativeNeedsEntropy::Finite(std::f64::consts::LN_2);
        assert!((one_bit.in_base(LogBase::Two).unwrap() - 1.0).abs() < 1e-15);
        assert!((one_bit.in_base(LogBase::Ten).unwrap() - std::f64::consts::LOG10_2).abs() < 1e-15);
    }
}
