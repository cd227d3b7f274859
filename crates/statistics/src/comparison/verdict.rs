//! Verdicts of comparisons: better, worse, undecided, and with a margin equivalent.
//!
//! Two policies are *equivalent within a margin* if the 90 % interval of their mean difference lies inside
//! the margin on both sides. That is the two one-sided tests (TOST, Schuirmann 1987) at 5 %. Otherwise one
//! policy is *better* if a difference shows after correction and the 95 % interval excludes zero. It is
//! better *by over the margin* if that whole interval lies beyond the margin. Before all of this, two
//! policies are *the same* if no pair of trials differs: nothing is tested. All other comparisons are
//! *undecided*: more trials would decide them.

use serde::Serialize;

use super::{Comparison, Direction, short};

/// Confidence of the interval whose inclusion in the margin is two one-sided tests at 5 %.
pub const TOST_CONFIDENCE: f64 = 0.90;

/// The verdict of a comparison on its first policy.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It is better than the second.
    Better,
    /// It is worse than the second.
    Worse,
    /// It is above the second, in a metric that is neither good nor bad.
    Above,
    /// It is below the second, in a metric that is neither good nor bad.
    Below,
    /// The difference is smaller than the margin.
    Equivalent,
    /// Both are the same in all trials: no difference was possible, or none was seen.
    Same,
    /// The trials do not decide.
    #[default]
    Undecided,
}

impl Verdict {
    /// The verdict in a word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Better => "better",
            Self::Worse => "worse",
            Self::Above => "above",
            Self::Below => "below",
            Self::Equivalent => "equivalent",
            Self::Same => "the same",
            Self::Undecided => "undecided",
        }
    }

    /// Whether it says that a difference is shown.
    pub fn is_shown(self) -> bool {
        !matches!(self, Self::Equivalent | Self::Same | Self::Undecided)
    }
}

/// Whether a difference that is shown is larger than the margin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Beyond {
    /// The whole 95 % interval lies beyond the margin.
    Yes,
    /// The interval lies on both sides of the margin.
    Undecided,
}

/// A margin, and what the trials say of it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Judged {
    /// The margin.
    pub margin: f64,
    /// 90 % interval of the mean difference.
    pub interval_90: Option<[f64; 2]>,
    /// Pairs with 80 % power to detect a difference as large as the margin, and to show equivalence if there
    /// is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pairs_for_margin: Option<u64>,
    /// For a difference that is shown: whether it is larger than the margin.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub beyond: Option<Beyond>,
}

impl Comparison {
    /// The verdict, and what is known of the margin, for a table.
    pub fn verdict_in_words(&self) -> String {
        let verdict = self.verdict.name();
        let Some(judged) = &self.judged else { return verdict.to_owned() };
        let margin = short(judged.margin);
        match (self.verdict, judged.beyond) {
            (Verdict::Equivalent, _) => format!("{verdict} within {margin}"),
            (_, Some(Beyond::Yes)) => format!("{verdict} by over {margin}"),
            (_, Some(Beyond::Undecided)) => format!("{verdict}; over {margin}?"),
            (_, None) => verdict.to_owned(),
        }
    }
}

/// The verdict of a comparison, where a margin is known with it and the 90 % interval of the difference.
pub fn verdict(
    comparison: &Comparison,
    margin: Option<(f64, Option<[f64; 2]>)>,
    direction: Direction,
) -> Verdict {
    if comparison.verdict == Verdict::Same {
        return Verdict::Same;
    }
    let within = |margin: f64, [low, high]: [f64; 2]| -margin < low && high < margin;
    let is_equivalent = comparison.p.is_some()
        && margin.is_some_and(|(margin, interval)| interval.is_some_and(|ends| within(margin, ends)));
    let side = comparison.interval.map_or(0.0, |[low, high]| match (low > 0.0, high < 0.0) {
        (true, _) => 1.0,
        (_, true) => -1.0,
        _ => 0.0,
    });
    if is_equivalent {
        Verdict::Equivalent
    } else if side == 0.0 || !comparison.is_found() {
        Verdict::Undecided
    } else {
        match (direction, side > 0.0) {
            (Direction::Higher, true) | (Direction::Lower, false) => Verdict::Better,
            (Direction::Higher, false) | (Direction::Lower, true) => Verdict::Worse,
            (Direction::Neither, true) => Verdict::Above,
            (Direction::Neither, false) => Verdict::Below,
        }
    }
}

/// Whether a difference that is shown lies beyond the margin; `None` where none is shown.
pub fn beyond(comparison: &Comparison, margin: f64) -> Option<Beyond> {
    let [low, high] = comparison.interval.filter(|_| comparison.verdict.is_shown())?;
    Some(if low > margin || high < -margin { Beyond::Yes } else { Beyond::Undecided })
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand::rngs::ChaCha8Rng;
    use rand_distr::{Distribution, Normal};

    use super::*;
    use crate::bootstrap::{Width, bca_interval, interval};

    fn comparison(interval: [f64; 2], p: f64) -> Comparison {
        Comparison { interval: Some(interval), p: Some(p), p_holm: Some(p), ..Comparison::default() }
    }

    #[test]
    fn a_verdict_needs_the_interval_and_the_corrected_test() {
        let far: Vec<f64> = (0..40).map(|i| 10.0 + f64::from(i % 5)).collect();
        let far = interval(&far, TOST_CONFIDENCE);
        let clear = comparison([9.0, 13.0], 0.001);
        assert_eq!(verdict(&clear, None, Direction::Higher), Verdict::Better);
        assert_eq!(verdict(&clear, Some((3.0, far)), Direction::Lower), Verdict::Worse);
        assert_eq!(verdict(&clear, None, Direction::Neither), Verdict::Above);
        assert_eq!(verdict(&clear, Some((20.0, far)), Direction::Higher), Verdict::Equivalent);
        let uncorrected = comparison([9.0, 13.0], 0.2);
        assert_eq!(verdict(&uncorrected, Some((3.0, far)), Direction::Higher), Verdict::Undecided);
        let of = |interval, margin: f64| {
            let mut one = comparison(interval, 0.001);
            one.verdict = verdict(&one, Some((margin, far)), Direction::Higher);
            let beyond = beyond(&one, margin);
            one.judged = Some(Judged { margin, interval_90: far, pairs_for_margin: None, beyond });
            one.verdict_in_words()
        };
        assert_eq!(of([9.0, 13.0], 3.0), "better by over 3.00");
        assert_eq!(of([1.0, 13.0], 3.0), "better; over 3.00?");
        assert_eq!(of([9.0, 13.0], 20.0), "equivalent within 20.0");
        assert_eq!(of([-1.0, 13.0], 3.0), "undecided");
        assert_eq!(of([-13.0, -9.0], 3.0), "worse by over 3.00");
    }

    /// Two policies whose true difference equals the margin are called equivalent in about 5 % of
    /// experiments.
    #[test]
    fn a_difference_as_large_as_the_margin_is_seldom_called_equivalent() {
        let truth = Normal::new(1.0, 2.0).unwrap();
        let mut draws = ChaCha8Rng::seed_from_u64(3);
        let is_called = |draws: &mut ChaCha8Rng| {
            let values: Vec<f64> = (0..60).map(|_| truth.sample(draws)).collect();
            let [low, high] = bca_interval(&values, TOST_CONFIDENCE, 1_000, 1, Width::Expanded).unwrap();
            -1.0 < low && high < 1.0
        };
        let called = (0..1_000).filter(|_| is_called(&mut draws)).count();
        assert!((25..=75).contains(&called), "{called} of 1,000");
    }
}
