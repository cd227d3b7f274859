//! Interactions: whether a difference between two policies depends on the scenario. An interaction is a
//! difference of differences, paired by seed, between a case of a sweep with axes and its reference: the
//! case in which one axis has its first value instead.

use serde::Serialize;
use store::Failure;

use super::cell::{Cell, hashes};
use super::effect::{Contrast, contrasts, corrected, is_shown};
use super::{CONFIDENCE, Choice, LEAST_PAIRS, Repeats, by_trial, p_in_words, policy_pairs, short};
use crate::sweep::folder::Folder;
use statistics::Moments;
use statistics::bootstrap::interval;
use statistics::wilcoxon::SignedRank;

/// How the difference of two policies changes with one field of the scenario.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Interaction {
    /// Number of the case, from 1.
    pub case: usize,
    /// Number of the reference, the case with which it is compared.
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
    /// The second policy.
    pub b: String,
    /// Seeds for which the metric is defined in all four trials.
    pub n: usize,
    /// Mean difference of the policies in the reference, and in the case.
    pub differences: Option<[f64; 2]>,
    /// Difference in the case minus difference in the reference.
    pub change: Option<f64>,
    /// 95 % bootstrap interval of the change.
    pub interval: Option<[f64; 2]>,
    /// Two-sided p of Wilcoxon's signed-rank test.
    pub p: Option<f64>,
    /// p after Holm's correction over all interactions.
    pub p_holm: Option<f64>,
    /// The finding in words.
    pub in_words: String,
}

impl Interaction {
    /// Whether the change shows after correction.
    pub fn is_found(&self) -> bool {
        is_shown(self.p_holm, self.interval)
    }
}

/// The interactions of a sweep's axes with differences between these policies; empty without axes.
///
/// # Errors
/// An unknown policy.
pub fn interactions(folder: &Folder, metrics: &[usize], choice: Choice) -> Result<Vec<Interaction>, Failure> {
    let experiment = folder.experiment();
    let pairs = policy_pairs(experiment, choice)?;
    let mut found = Vec::new();
    for contrast in contrasts(experiment) {
        for metric in metrics {
            for pair in &pairs {
                found.push(interaction(folder, contrast, *metric, *pair));
            }
        }
    }
    let ps: Vec<Option<f64>> = found.iter().map(|interaction| interaction.p).collect();
    for (interaction, p) in found.iter_mut().zip(corrected(&ps)) {
        interaction.p_holm = p;
        interaction.in_words = in_words(interaction);
    }
    Ok(found)
}

fn interaction(folder: &Folder, contrast: Contrast, metric: usize, pair: [usize; 2]) -> Interaction {
    let experiment = folder.experiment();
    let Contrast { case, reference, axis } = contrast;
    let cells = |case: usize| pair.map(|policy| (case, policy));
    let differences = [reference, case].map(|case| by_trial(folder, metric, cells(case)));
    let [there, here] = differences;
    let all: Vec<Cell> = [reference, case].into_iter().flat_map(cells).collect();
    let mut repeats = Repeats::default();
    let trials = (1..).zip(there.into_iter().zip(here));
    let new = trials.filter(|(trial, _)| repeats.is_new(*trial, &hashes(folder, &all, *trial)));
    let both: Vec<[f64; 2]> = new.filter_map(|(_, (there, here))| Some([there?, here?])).collect();
    let column = |i: usize| both.iter().map(|pair| pair[i]).collect::<Vec<f64>>();
    let changes: Vec<f64> = both.iter().map(|[there, here]| here - there).collect();
    let [a, b] = pair.map(|policy| experiment.policies[policy].label.clone());
    Interaction {
        case: case + 1,
        reference: reference + 1,
        path: experiment.axes[axis].path.clone(),
        values: contrast.values(experiment),
        others: contrast.others(experiment),
        metric: experiment.metrics[metric].name.clone(),
        a,
        b,
        n: changes.len(),
        differences: Moments::of(&column(0)).mean.zip(Moments::of(&column(1)).mean).map(|(x, y)| [x, y]),
        change: Moments::of(&changes).mean,
        interval: interval(&changes, CONFIDENCE),
        p: (changes.len() >= LEAST_PAIRS).then(|| SignedRank::of(&changes).p),
        p_holm: None,
        in_words: String::new(),
    }
}

fn in_words(interaction: &Interaction) -> String {
    let Interaction { metric, path, values: [from, to], a, b, n, .. } = interaction;
    let others = interaction.others.iter().map(|(path, value)| format!(" (at {path}={value})"));
    let others = others.collect::<Vec<_>>().concat();
    let place = format!("{metric}, {path} from {from} to {to}{others}");
    let (Some([there, here]), Some(change), Some(p), Some([low, high])) =
        (interaction.differences, interaction.change, interaction.p_holm, interaction.interval)
    else {
        return format!("{place}: nothing can be said of {a} less {b}: there are too few seeds.");
    };
    let course = format!("{a} less {b} goes from {} to {}", short(there), short(here));
    let range = format!("change {}, 95 % interval {} to {}, n = {n}", short(change), short(low), short(high));
    let verdict = if interaction.is_found() { "" } else { ", which is not shown to be a change" };
    format!("{place}: {course}{verdict} ({range}; corrected {}).", p_in_words(p))
}
