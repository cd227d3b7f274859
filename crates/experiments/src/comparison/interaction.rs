//! Interactions: whether a difference between two policies depends on the scenario. An interaction is a
//! difference of differences, paired by seed, between a case of a sweep with axes and its reference: the
//! case in which one axis has its first value instead.

use serde::Serialize;
use store::Failure;

use super::effect::{Contrast, contrasts, corrected, is_shown};
use super::{CONFIDENCE, Choice, Pairs, Standing, Trials, p_in_words, policy_pairs, short};
use crate::sweep::folder::Folder;
use statistics::Moments;
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
    let cells = [reference, case].map(|case| pair.map(|policy| ((case, policy), metric)));
    let found = Trials::of(folder, case).joint(&cells);
    let pairs = Pairs { a: found[1].differences(), b: found[0].differences(), ..Pairs::default() };
    let [there, here] = [0, 1].map(|case| found[case].tested());
    let tested: Vec<f64> = here.iter().zip(there).map(|(here, there)| here - there).collect();
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
        n: pairs.a.len(),
        differences: Moments::of(&pairs.b).mean.zip(Moments::of(&pairs.a).mean).map(|(x, y)| [x, y]),
        change: pairs.difference(),
        interval: pairs.interval(CONFIDENCE),
        p: (pairs.standing() == Standing::Judged).then(|| SignedRank::of(&tested).p),
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
        let standing = Standing::of(*n, interaction.change == Some(0.0));
        return format!("{place}: nothing is tested of {a} less {b}: {standing}.");
    };
    let course = format!("{a} less {b} goes from {} to {}", short(there), short(here));
    let range = format!("change {}, 95 % interval {} to {}, n = {n}", short(change), short(low), short(high));
    let verdict = if interaction.is_found() { "" } else { ", which is not shown to be a change" };
    format!("{place}: {course}{verdict} ({range}; corrected {}).", p_in_words(p))
}
