//! What differs between two subjects that were tried in pairs, by how much, and how certain the difference
//! is.

mod answer;
mod pairs;
mod sums;
mod verdict;
mod words;

use serde::Serialize;

use crate::Moments;
use crate::paired::{detectable, hodges_lehmann, holm, pairs_for_margin};
use crate::wilcoxon::{DRAWN_PAIRS, DRAWS, EXACT_PAIRS, SignedRank};

pub use crate::paired::LEAST_PAIRS;
pub use answer::{answer, answer_of_cases, what_is_the_same, what_would_settle};
pub use pairs::{Pairs, Repeats, Standing};
pub use sums::{FEW, Sums, linearised};
pub use verdict::{Beyond, Judged, TOST_CONFIDENCE, Verdict};
use verdict::{beyond, verdict};
use words::in_words;
pub use words::{digits, p_in_words, short, short_p};

/// Which direction of a metric is better.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// More is better.
    Higher,
    /// Less is better.
    Lower,
    /// It is neither good nor bad.
    Neither,
}

/// Significance level of a finding, after correction.
pub const LEVEL: f64 = 0.05;
/// Confidence of intervals.
pub const CONFIDENCE: f64 = 0.95;

/// Two policies over the same seeds, in one metric.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Comparison {
    /// Number of the case, from 1.
    pub case: usize,
    /// The case's values of the axes, in RON.
    pub axes: Vec<(String, String)>,
    /// Name of the metric.
    pub metric: String,
    /// The first policy.
    pub a: String,
    /// The second policy.
    pub b: String,
    /// Distinct pairs in which the metric is defined for both.
    pub n: usize,
    /// Pairs that repeat others, to the last state: where nothing is drawn, seeds do not matter.
    pub repeated: usize,
    /// Pairs with at least one failed trial.
    pub failed: usize,
    /// Pairs with at least one trial that has not been run.
    pub missing: usize,
    /// Pairs with at least one trial in which the metric is undefined.
    pub undefined: usize,
    /// Whether it compares ratios of sums, because some trial has few rescuees or none. The means are then
    /// these ratios.
    pub is_of_sums: bool,
    /// Mean of the first policy over these pairs.
    pub mean_a: Option<f64>,
    /// Mean of the second policy.
    pub mean_b: Option<f64>,
    /// Mean of the differences, first minus second.
    pub difference: Option<f64>,
    /// 95 % bootstrap interval of the mean difference; `None` where the pairs are not [judged](Standing).
    pub interval: Option<[f64; 2]>,
    /// Hodges-Lehmann shift.
    pub shift: Option<f64>,
    /// Two-sided p of Wilcoxon's signed-rank test; likewise.
    pub p: Option<f64>,
    /// Whether p was counted over all choices of signs, instead of from random choices.
    pub is_exact: bool,
    /// p after Holm's correction over all comparisons made together.
    pub p_holm: Option<f64>,
    /// Matched-pairs rank-biserial correlation.
    pub effect: Option<f64>,
    /// Gain from pairing: how many times as many unpaired trials would give the mean difference with the
    /// same precision. The variance of the difference without pairing (the sum of both variances) over the
    /// variance with pairing.
    pub pairing: Option<f64>,
    /// The least true mean difference that this many pairs detect with 80 % power, in a single test.
    pub detectable: Option<f64>,
    /// The verdict on the first policy.
    pub verdict: Verdict,
    /// What the trials say of the margin, where one is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub judged: Option<Judged>,
    /// The finding in words.
    pub in_words: String,
}

impl Comparison {
    /// Whether a difference shows after correction.
    pub fn is_found(&self) -> bool {
        self.p_holm.is_some_and(|p| p < LEVEL)
    }

    /// Whether the difference is shown to be smaller than the margin.
    pub fn is_equivalent(&self) -> bool {
        self.verdict == Verdict::Equivalent
    }

    /// The same comparison, of which the names are known, with what these pairs say: all but what takes the
    /// whole [family](correct), and the [verdict](Self::judge).
    #[must_use]
    pub fn measured(self, pairs: &Pairs) -> Self {
        let differences = pairs.differences();
        let tested = pairs.tested();
        let test = SignedRank::of(&tested);
        let has_pairs = !differences.is_empty();
        let standing = pairs.standing();
        Self {
            n: differences.len(),
            repeated: pairs.repeated,
            failed: pairs.failed,
            missing: pairs.missing,
            undefined: pairs.undefined,
            is_of_sums: pairs.sums.is_some(),
            mean_a: Moments::of(&pairs.a).mean,
            mean_b: Moments::of(&pairs.b).mean,
            difference: pairs.difference(),
            interval: pairs.interval(CONFIDENCE),
            shift: hodges_lehmann(&tested),
            p: (standing == Standing::Judged).then_some(test.p),
            verdict: if standing == Standing::Same { Verdict::Same } else { Verdict::Undecided },
            is_exact: test.is_exact,
            effect: has_pairs.then(|| test.effect()),
            pairing: pairing(pairs, &differences),
            detectable: Moments::of(&differences).sd.and_then(|sd| detectable(sd, differences.len())),
            ..self
        }
    }

    /// Adds the verdict, what the pairs say of a margin if there is one, and the finding in words. The
    /// family must be [corrected](correct).
    pub fn judge(&mut self, direction: Direction, margin: Option<(f64, &Pairs)>) {
        let with_margin = margin.map(|(margin, pairs)| {
            (margin, pairs.interval(TOST_CONFIDENCE), pairs_for_margin(&pairs.differences(), margin))
        });
        let interval = with_margin.map(|(margin, interval, _)| (margin, interval));
        self.verdict = verdict(self, interval, direction);
        self.judged = with_margin.map(|(margin, interval_90, pairs_for_margin)| Judged {
            margin,
            interval_90,
            pairs_for_margin,
            beyond: beyond(self, margin),
        });
        self.in_words = in_words(self);
    }
}

/// Holm's correction over a family of comparisons: all that are made together.
pub fn correct(family: &mut [Comparison]) {
    let tested: Vec<usize> = (0..family.len()).filter(|i| family[*i].p.is_some()).collect();
    let ps: Vec<f64> = tested.iter().filter_map(|i| family[*i].p).collect();
    for (i, p) in tested.into_iter().zip(holm(&ps)) {
        family[i].p_holm = Some(p);
    }
}

/// A warning if the family of comparisons is so large, and the pairs are so few, that no difference can be
/// significant after correction.
pub fn limit_of_correction(comparisons: &[Comparison]) -> Option<String> {
    let family = comparisons.iter().filter(|comparison| comparison.p.is_some()).count();
    let most = comparisons.iter().map(|comparison| comparison.n).max()?;
    limit(most, family, "comparisons")
}

/// The warning for a family of tests on so many pairs at most; `what` names the tests.
pub fn limit(most: usize, family: usize, what: &str) -> Option<String> {
    let smallest = if most > EXACT_PAIRS {
        2.0 / f64::from(DRAWS + 1)
    } else {
        2.0_f64.powi(1 - i32::try_from(most).ok()?)
    };
    let least = smallest * family as f64;
    (family > 0 && least >= LEVEL).then(|| {
        format!(
            "At n = {most} the smallest p there is, {}, becomes {} after correction over {family} {what}: \
             none can be shown, however large. Compare fewer things, chosen beforehand (--metric, \
             --baseline), or run more trials.",
            short(smallest),
            short(least.min(1.0))
        )
    })
}

/// How p was computed, in words.
pub fn test_in_words(comparisons: &[Comparison]) -> String {
    let most = comparisons.iter().map(|comparison| comparison.n).max().unwrap_or(0);
    if comparisons.iter().all(|comparison| comparison.is_exact) {
        "p exact".to_owned()
    } else if most <= DRAWN_PAIRS {
        format!("p exact to {EXACT_PAIRS} pairs, beyond from {DRAWS} random choices of signs")
    } else {
        format!(
            "p exact to {EXACT_PAIRS} pairs, to {DRAWN_PAIRS} from {DRAWS} random choices of signs, beyond \
             normal"
        )
    }
}

/// The gain from pairing; `None` if all differences are equal.
fn pairing(pairs: &Pairs, differences: &[f64]) -> Option<f64> {
    let variance = |values: &[f64]| Moments::of(values).sd.map(|sd| sd * sd);
    let paired = variance(differences).filter(|variance| *variance > 0.0)?;
    Some((variance(&pairs.a)? + variance(&pairs.b)?) / paired)
}
