//! Paired comparisons of policies: what differs, by how much, and how certain the difference is.

mod answer;
mod asked;
mod cell;
mod doubts;
mod effect;
mod equivalence;
mod interaction;
mod own;
mod pairs;
mod sums;
mod words;

use rayon::prelude::*;
use serde::Serialize;
use store::{Failure, refuse};

use crate::experiment::Experiment;
use crate::metric::Metric;
use crate::stats::Moments;
use crate::stats::paired::{detectable, hodges_lehmann, holm, pairs_for_margin};
use crate::stats::wilcoxon::{DRAWN_PAIRS, DRAWS, EXACT_PAIRS, SignedRank};
use crate::sweep::folder::Folder;

pub use answer::{answer, answer_of_cases, what_would_settle};
pub use asked::{Asked, Wishes};
pub use cell::Cell;
pub use doubts::doubts;
pub use effect::{Effect, effects};
pub use equivalence::{Beyond, Judged, TOST_CONFIDENCE, Verdict};
use equivalence::{beyond, verdict};
pub use interaction::{Interaction, interactions};
pub use own::own_question;
pub use pairs::Pairs;
pub use sums::{FEW, moments_of};
use words::in_words;
pub use words::{digits, short, short_p};

/// Significance level of a finding, after correction.
pub const LEVEL: f64 = 0.05;
/// The least number of distinct pairs that give a p value and a verdict: with fewer, no p is below 0.05.
pub const LEAST_PAIRS: usize = 6;
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
    /// 95 % bootstrap interval of the mean difference.
    pub interval: Option<[f64; 2]>,
    /// Hodges-Lehmann shift.
    pub shift: Option<f64>,
    /// Two-sided p of Wilcoxon's signed-rank test; `None` below six pairs.
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
    #[must_use]
    pub fn is_found(&self) -> bool {
        self.p_holm.is_some_and(|p| p < LEVEL)
    }

    /// Whether the difference is shown to be smaller than the margin.
    #[must_use]
    pub fn is_equivalent(&self) -> bool {
        self.verdict == Verdict::Equivalent
    }
}

/// A warning if the family of comparisons is so large, and the pairs are so few, that no difference can be
/// significant after correction.
#[must_use]
pub fn limit_of_correction(comparisons: &[Comparison]) -> Option<String> {
    let family = comparisons.iter().filter(|comparison| comparison.p.is_some()).count();
    let most = comparisons.iter().map(|comparison| comparison.n).max()?;
    limit(most, family, "comparisons")
}

/// The same warning for the changes along axes: of means, or of differences.
#[must_use]
pub fn limit_of_changes(effects: &[Effect], interactions: &[Interaction]) -> Option<String> {
    let of_effects = || effects.iter().filter(|effect| effect.p.is_some()).map(|effect| effect.n);
    let of_interactions = || interactions.iter().filter(|one| one.p.is_some()).map(|one| one.n);
    limit(of_effects().max()?, of_effects().count(), "changes of means")
        .or_else(|| limit(of_interactions().max()?, of_interactions().count(), "changes of differences"))
}

/// The warning for a family of tests on so many pairs at most.
fn limit(most: usize, family: usize, what: &str) -> Option<String> {
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
#[must_use]
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

/// Which policies are compared, by their labels.
#[derive(Debug, Clone, Copy, Default)]
pub struct Choice<'a> {
    /// The policy with which the others are compared; `None` for all pairs.
    pub baseline: Option<&'a str>,
    /// The only policies to compare; `None` for all.
    pub policies: Option<&'a [String]>,
    /// For metrics, by their places, the largest difference that does not matter.
    pub margins: &'a [(usize, f64)],
}

/// All comparisons of these metrics: of each pair of policies, or of each policy with the baseline.
///
/// # Errors
/// An unknown policy, or only one although the sweep has no axes.
pub fn compare(folder: &Folder, metrics: &[usize], choice: Choice) -> Result<Vec<Comparison>, Failure> {
    let experiment = folder.experiment();
    let pairs = policy_pairs(experiment, choice)?;
    let cases = 0..experiment.cases.len();
    let all: Vec<(usize, usize, [usize; 2])> = cases
        .flat_map(|case| metrics.iter().map(move |metric| (case, *metric)))
        .flat_map(|(case, metric)| pairs.iter().map(move |pair| (case, metric, *pair)))
        .collect();
    let one = |(case, metric, pair): &(usize, usize, [usize; 2])| {
        let pairs = Pairs::of(folder, *metric, pair.map(|policy| (*case, policy)));
        comparison(experiment, *case, &experiment.metrics[*metric], *pair, &pairs)
    };
    let mut comparisons: Vec<Comparison> = all.par_iter().map(one).collect();
    let tested: Vec<usize> = (0..comparisons.len()).filter(|i| comparisons[*i].p.is_some()).collect();
    let ps: Vec<f64> = tested.iter().filter_map(|i| comparisons[*i].p).collect();
    for (i, p) in tested.into_iter().zip(holm(&ps)) {
        comparisons[i].p_holm = Some(p);
    }
    for (comparison, (case, metric, pair)) in comparisons.iter_mut().zip(&all) {
        let direction = experiment.metrics[*metric].direction;
        let margin = choice.margins.iter().find(|(place, _)| place == metric).map(|(_, margin)| *margin);
        let with_margin = margin.map(|margin| {
            let pairs = Pairs::of(folder, *metric, pair.map(|policy| (*case, policy)));
            (margin, pairs.interval(TOST_CONFIDENCE), pairs_for_margin(&pairs.differences(), margin))
        });
        let interval = with_margin.map(|(margin, interval, _)| (margin, interval));
        comparison.verdict = verdict(comparison, interval, direction);
        comparison.judged = with_margin.map(|(margin, interval_90, pairs_for_margin)| Judged {
            margin,
            interval_90,
            pairs_for_margin,
            beyond: beyond(comparison, margin),
        });
        comparison.in_words = in_words(comparison);
    }
    Ok(comparisons)
}

/// The places of the chosen policies, with the baseline.
fn policies_of(experiment: &Experiment, choice: Choice) -> Result<Vec<usize>, Failure> {
    let baseline = choice.baseline.map(|name| place(experiment, "--baseline", name)).transpose()?;
    let mut chosen: Vec<usize> = (0..experiment.policies.len()).collect();
    if let Some(policies) = choice.policies {
        let places = policies.iter().map(|name| place(experiment, "--policies", name));
        let places = places.collect::<Result<Vec<_>, _>>()?;
        chosen.retain(|policy| places.contains(policy) || baseline == Some(*policy));
    }
    Ok(chosen)
}

fn place(experiment: &Experiment, option: &str, wanted: &str) -> Result<usize, Failure> {
    let mut labels = experiment.policies.iter().map(|policy| policy.label.as_str());
    labels.position(|label| label == wanted).ok_or_else(|| {
        let known: Vec<&str> = experiment.policies.iter().map(|policy| policy.label.as_str()).collect();
        let known = known.join(", ");
        Failure::input(format!("{option}: must be a policy of the sweep ({known}), found {wanted:?}"))
    })
}

pub(crate) fn policy_pairs(experiment: &Experiment, choice: Choice) -> Result<Vec<[usize; 2]>, Failure> {
    let chosen = policies_of(experiment, choice)?;
    let baseline = choice.baseline.map(|name| place(experiment, "--baseline", name)).transpose()?;
    if let [only] = chosen[..] {
        if experiment.cases.len() > 1 {
            return Ok(Vec::new());
        }
        let only = &experiment.policies[only].label;
        refuse!(
            "there is nothing to compare: {only} only; the sweep with `--policies {only},...` adds others to it"
        );
    }
    let pairs = |(i, a): (usize, &usize)| chosen[i + 1..].iter().map(|b| [*a, *b]).collect::<Vec<_>>();
    let pairs: Vec<[usize; 2]> = match baseline {
        None => chosen.iter().enumerate().flat_map(pairs).collect(),
        Some(baseline) => chosen.iter().filter(|a| **a != baseline).map(|a| [*a, baseline]).collect(),
    };
    Ok(pairs.into_iter().map(|pair| signed(experiment, pair)).collect())
}

/// The pair with the sign that it has in every answer of a folder: the sweep file's baseline is what is
/// taken off; without one, it is the first policy of the sweep that something is taken off from.
fn signed(experiment: &Experiment, [a, b]: [usize; 2]) -> [usize; 2] {
    let declared = experiment.plan.baseline.as_deref();
    let is_baseline = |policy: usize| declared == Some(experiment.policies[policy].label.as_str());
    let is_turned = is_baseline(a) || (declared.is_none() && b == 0);
    if is_turned { [b, a] } else { [a, b] }
}

fn comparison(
    experiment: &Experiment,
    case: usize,
    metric: &Metric,
    pair: [usize; 2],
    pairs: &Pairs,
) -> Comparison {
    let differences = pairs.differences();
    let [a, b] = pair.map(|policy| experiment.policies[policy].label.clone());
    let values = experiment.axes.iter().zip(&experiment.cases[case].values);
    let test = SignedRank::of(&differences);
    let has_pairs = !differences.is_empty();
    let is_tested = differences.len() >= LEAST_PAIRS;
    Comparison {
        case: case + 1,
        axes: values.map(|(axis, value)| (axis.path.clone(), value.clone())).collect(),
        metric: metric.name.clone(),
        a,
        b,
        n: differences.len(),
        repeated: pairs.repeated,
        failed: pairs.failed,
        missing: pairs.missing,
        undefined: pairs.undefined,
        is_of_sums: pairs.sums.is_some(),
        mean_a: Moments::of(&pairs.a).mean,
        mean_b: Moments::of(&pairs.b).mean,
        difference: Moments::of(&differences).mean,
        interval: pairs.interval(CONFIDENCE),
        shift: hodges_lehmann(&differences),
        p: is_tested.then_some(test.p),
        is_exact: test.is_exact,
        p_holm: None,
        effect: has_pairs.then(|| test.effect()),
        pairing: pairing(pairs, &differences),
        detectable: Moments::of(&differences).sd.and_then(|sd| detectable(sd, differences.len())),
        verdict: Verdict::Undecided,
        judged: None,
        in_words: String::new(),
    }
}

/// The gain from pairing; `None` if all differences are equal.
fn pairing(pairs: &Pairs, differences: &[f64]) -> Option<f64> {
    let variance = |values: &[f64]| Moments::of(values).sd.map(|sd| sd * sd);
    let paired = variance(differences).filter(|variance| *variance > 0.0)?;
    Some((variance(&pairs.a)? + variance(&pairs.b)?) / paired)
}
