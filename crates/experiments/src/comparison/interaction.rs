//! Interactions: does a difference between two policies depend on the scenario? The difference of
//! differences, paired by seed, between a case of a sweep with axes and the case in which one axis has its
//! first value instead.

use serde::Serialize;

use super::{CONFIDENCE, Choice, LEVEL, Pairs, p_in_words, policy_pairs, short};
use crate::experiment::Experiment;
use crate::failure::Failure;
use crate::stats::Moments;
use crate::stats::bootstrap::interval;
use crate::stats::paired::holm;
use crate::stats::wilcoxon::SignedRank;
use crate::sweep::folder::Folder;

/// How the difference of two policies changes with one field of the scenario.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Interaction {
    /// Number of the case, from 1.
    pub case: usize,
    /// Number of the case that it is compared with.
    pub reference: usize,
    /// The field that differs.
    pub path: String,
    /// Its value in the reference, and in the case.
    pub values: [String; 2],
    /// The other axes and their values, the same in both.
    pub others: Vec<(String, String)>,
    /// Name of the metric.
    pub metric: String,
    /// The first policy.
    pub a: String,
    /// The second.
    pub b: String,
    /// Seeds for which the metric is defined in all four trials.
    pub n: usize,
    /// Mean difference of the policies in the reference, and in the case.
    pub differences: Option<[f64; 2]>,
    /// The second less the first.
    pub change: Option<f64>,
    /// Its 95 % bootstrap interval.
    pub interval: Option<[f64; 2]>,
    /// Two-sided p of Wilcoxon's signed-rank test.
    pub p: Option<f64>,
    /// p after Holm's correction over all interactions.
    pub p_holm: Option<f64>,
    /// The finding in words.
    pub in_words: String,
}

/// The interactions of a sweep with axes, for these metrics and policies: none without axes.
///
/// # Errors
/// An unknown policy, or fewer than two.
pub fn interactions(folder: &Folder, metrics: &[usize], choice: Choice) -> Result<Vec<Interaction>, Failure> {
    let experiment = folder.experiment();
    let pairs = policy_pairs(experiment, choice)?;
    let mut found = Vec::new();
    for (case, reference, axis) in contrasts(experiment) {
        for metric in metrics {
            for pair in &pairs {
                found.push(interaction(folder, [reference, case], axis, *metric, *pair));
            }
        }
    }
    let tested: Vec<usize> = (0..found.len()).filter(|i| found[*i].p.is_some()).collect();
    let ps: Vec<f64> = tested.iter().filter_map(|i| found[*i].p).collect();
    for (i, p) in tested.into_iter().zip(holm(&ps)) {
        found[i].p_holm = Some(p);
    }
    for interaction in &mut found {
        interaction.in_words = in_words(interaction, experiment.metrics.title(&interaction.metric));
    }
    Ok(found)
}

/// Pairs of cases that differ in one axis only, where the first of them has the axis's first value: the case,
/// its reference, the axis.
fn contrasts(experiment: &Experiment) -> Vec<(usize, usize, usize)> {
    let cases = &experiment.cases;
    let mut contrasts = Vec::new();
    for (axis, of) in experiment.axes.iter().enumerate() {
        for (case, one) in cases.iter().enumerate() {
            let is_reference = |other: &crate::experiment::Case| {
                let mut values = one.values.iter().zip(&other.values).enumerate();
                values
                    .all(|(i, (here, there))| if i == axis { *there == of.values[0] } else { here == there })
            };
            if one.values[axis] != of.values[0] {
                contrasts
                    .extend(cases.iter().position(is_reference).map(|reference| (case, reference, axis)));
            }
        }
    }
    contrasts
}

fn interaction(
    folder: &Folder,
    [reference, case]: [usize; 2],
    axis: usize,
    metric: usize,
    pair: [usize; 2],
) -> Interaction {
    let experiment = folder.experiment();
    let differences = [reference, case].map(|case| Pairs::by_trial(folder, case, metric, pair));
    let [there, here] = differences;
    let both: Vec<[f64; 2]> =
        there.into_iter().zip(here).filter_map(|(there, here)| Some([there?, here?])).collect();
    let column = |i: usize| both.iter().map(|pair| pair[i]).collect::<Vec<f64>>();
    let changes: Vec<f64> = both.iter().map(|[there, here]| here - there).collect();
    let [a, b] = pair.map(|policy| experiment.policies[policy].label.clone());
    let values = |case: usize| experiment.cases[case].values[axis].clone();
    let others = experiment.axes.iter().zip(&experiment.cases[case].values).enumerate();
    Interaction {
        case: case + 1,
        reference: reference + 1,
        path: experiment.axes[axis].path.clone(),
        values: [values(reference), values(case)],
        others: others
            .filter(|(i, _)| *i != axis)
            .map(|(_, (axis, value))| (axis.path.clone(), value.clone()))
            .collect(),
        metric: experiment.metrics[metric].name.clone(),
        a,
        b,
        n: changes.len(),
        differences: Moments::of(&column(0)).mean.zip(Moments::of(&column(1)).mean).map(|(x, y)| [x, y]),
        change: Moments::of(&changes).mean,
        interval: interval(&changes, CONFIDENCE),
        p: (!changes.is_empty()).then(|| SignedRank::of(&changes).p),
        p_holm: None,
        in_words: String::new(),
    }
}

fn in_words(interaction: &Interaction, title: &str) -> String {
    let Interaction { path, values: [from, to], a, b, n, .. } = interaction;
    let others = interaction.others.iter().map(|(path, value)| format!(" (at {path}={value})"));
    let others = others.collect::<Vec<_>>().concat();
    let place = format!("{title}, {path} from {from} to {to}{others}");
    let (Some([there, here]), Some(change), Some(p), Some([low, high])) =
        (interaction.differences, interaction.change, interaction.p_holm, interaction.interval)
    else {
        return format!("{place}: nothing can be said of {a} less {b}: there are too few seeds.");
    };
    let course = format!("{a} less {b} goes from {} to {}", short(there), short(here));
    let range = format!("change {}, 95 % interval {} to {}, n = {n}", short(change), short(low), short(high));
    let verdict =
        if p < LEVEL && (low > 0.0 || high < 0.0) { "" } else { ", which is not shown to be a change" };
    format!("{place}: {course}{verdict} ({range}; corrected {}).", p_in_words(p))
}
